#include <gmock/gmock.h>

#include <clocale>
#include <cstdlib>
#include <map>

#include "random_parameters.h"
#include "tests/support.h"
#include "trimtab/preset/preset.h"

namespace trimtab {
namespace {

using test::sameBits;
using ::testing::HasSubstr;

std::filesystem::path data() {
  return test::sourceDir() / "tests/data/presets";
}

std::string presetWith(const std::string& parameters, const std::string& members = "") {
  return "{\n  \"format\": \"trimtab-preset\",\n  \"version\": 3,\n  \"name\": \"p\",\n" + members +
         "  \"parameters\": {\n    " + parameters + "\n  }\n}\n";
}

TEST(PresetFile, readsBackBitForBitWhateverItsBase) {
  test::RandomParameters random(4);
  for (int i = 0; i < 200; ++i) {
    Preset preset;
    preset.name = "caf\xc3\xa9 \"\\\n\x01";
    preset.base = i % 3 == 0 ? "" : i % 3 == 1 ? "default" : "as-printed";
    preset.description = "</x>";
    preset.parameters = random();
    const auto text = presetText(preset);
    ASSERT_TRUE(text) << toString(text.findings());
    const auto back = parsePreset(*text, "memory");
    ASSERT_TRUE(back) << toString(back.findings()) << *text;
    EXPECT_TRUE(sameBits(back->parameters, preset.parameters));
    EXPECT_EQ(back->name, preset.name);
    EXPECT_EQ(back->base, preset.base);
    EXPECT_EQ(back->description, preset.description);
    EXPECT_EQ(*presetText(*back), *text);
  }
}

TEST(PresetFile, doesNotDependOnTheLocale) {
  const test::ScratchDir dir;
  if (test::run("localedef -i de_DE -f UTF-8 " + (dir / "de_DE.UTF-8").string()).exitCode != 0)
    GTEST_SKIP() << "needs localedef and its sources";
  ::setenv("LOCPATH", dir.path().c_str(), 1);
  const bool comma = std::setlocale(LC_ALL, "de_DE.UTF-8") != nullptr && std::strtod("0,5", nullptr) == 0.5;
  Preset preset;
  preset.parameters.scheme.hysteresis = Membership{0.025};
  preset.parameters.scheme.bands.band[0].low = 0.15;
  const auto text = presetText(preset);
  const auto back = parsePreset(*text, "memory");
  const auto exported =
      parsePreset(exportText(*validate(preset.parameters), "n", {}, ExportFormat::json), "memory");
  const auto typed = parseValue(*findRow("lod.scale"), "1.5");
  std::setlocale(LC_ALL, "C");
  ::unsetenv("LOCPATH");
  ASSERT_TRUE(comma);
  EXPECT_THAT(*text, HasSubstr("\"fuzzy.hysteresis\": 0.025"));
  ASSERT_TRUE(back && exported && typed);
  EXPECT_TRUE(sameBits(back->parameters, preset.parameters));
  EXPECT_TRUE(sameBits(exported->parameters, preset.parameters));
  EXPECT_EQ(std::get<double>(*typed), 1.5);
}

TEST(PresetFile, keepsANegativeZero) {
  Preset preset;
  preset.parameters.pitch.curve = {{-0.0, 1}, {30, -0.0}};
  const auto back = parsePreset(*presetText(preset), "memory");
  ASSERT_TRUE(back);
  EXPECT_TRUE(sameBits(back->parameters, preset.parameters));
}

TEST(PresetFile, holdsOnlyWhatDiffersFromItsBaseInTheTablesOrder) {
  Preset preset;
  preset.name = "p";
  preset.base = "as-published";
  preset.parameters = loadPreset("as-published")->parameters;
  preset.parameters.lod.scale = Ratio{3};
  preset.parameters.scheme.hysteresis = Membership{0.05};
  EXPECT_EQ(*presetText(preset), presetWith("\"fuzzy.hysteresis\": 0.05,\n    \"lod.scale\": 3",
                                            "  \"base\": \"as-published\",\n"));
}

TEST(PresetFile, refusesToWriteWhatCouldNotBeRead) {
  Preset preset;
  preset.parameters.lod.scale = Ratio{std::nan("")};
  EXPECT_FALSE(presetText(preset));
  preset.parameters = {};
  preset.base = "nowhere.json";
  EXPECT_FALSE(presetText(preset));
}

TEST(PresetFile, keepsUnknownKeysToTheByte) {
  const std::string unknown =
      "\"future.list_px\": [1,   2,\n      {\"a\\u00e9\": [\"]\", \"}\\\"\"]}],\n    \"future.number\": "
      "1.00000000000000000000001e-3";
  const std::string members = "  \"$schema\": \"preset.schema.json\",\n  \"tags\": {\"a\": [ ]},\n";
  const std::string text = presetWith("\"lod.scale\": 3,\n    " + unknown, members);
  const auto preset = parsePreset(text, "memory");
  ASSERT_TRUE(preset);
  EXPECT_EQ(*presetText(*preset), text);
}

TEST(PresetFile, saysWhichKeyWasProbablyMeant) {
  const auto preset = parsePreset(presetWith("\"fuzzy.histeresis\": 0.01"), "p.json");
  ASSERT_TRUE(preset);
  ASSERT_EQ(preset.findings().size(), 1u);
  EXPECT_EQ(toString(preset.findings()[0]),
            "p.json:6: fuzzy.histeresis: expected a parameter of this version (fuzzy.hysteresis?), found an "
            "unknown key, kept "
            "without effect");
  EXPECT_EQ(preset.findings()[0].severity, Severity::warning);
}

TEST(PresetFile, listsEveryOffenceWithItsLine) {
  const auto preset = parsePreset(presetWith("\"lod.scale\": \"x\",\n    \"view.near_m\": -1,\n    "
                                             "\"fuzzy.bands_px\": [[0.1, 1]],\n    \"host.extrapolate\": 0"),
                                  "p.json");
  ASSERT_FALSE(preset);
  std::map<std::string, std::string> places;
  for (const Finding& f : preset.findings()) places[f.key] = f.where;
  EXPECT_EQ(places, (std::map<std::string, std::string>{{"lod.scale", "p.json:6"},
                                                        {"view.near_m", "p.json:7"},
                                                        {"fuzzy.bands_px", "p.json:8"},
                                                        {"host.extrapolate", "p.json:9"}}));
}

TEST(PresetFile, findsItsBaseBesideItself) {
  const test::ScratchDir dir;
  std::filesystem::create_directory(dir / "sub");
  test::writeFile(dir / "sub/base.json", presetWith("\"lod.scale\": 3", "  \"base\": \"as-published\",\n"));
  test::writeFile(dir / "sub/top.json", presetWith("\"view.near_m\": 2", "  \"base\": \"base.json\",\n"));
  const auto preset = loadPreset((dir / "sub/top.json").string());
  ASSERT_TRUE(preset) << toString(preset.findings());
  EXPECT_EQ(preset->parameters.lod.scale.value(), 3);
  EXPECT_EQ(preset->parameters.scheme.hysteresis.value(), 0);
  EXPECT_EQ(*presetText(*preset), test::readFile(dir / "sub/top.json"));
  EXPECT_EQ(baseParameters(*preset)->lod.scale.value(), 3);
}

TEST(PresetFile, keepsABrokenRuleAsADraftAndSaysSo) {
  const auto preset = parsePreset(presetWith("\"fuzzy.hysteresis\": 0.3"), "p.json");
  ASSERT_TRUE(preset) << "a draft must survive being saved";
  ASSERT_FALSE(preset.findings().empty());
  EXPECT_EQ(preset->parameters.scheme.hysteresis.value(), 0.3);
  EXPECT_FALSE(validate(preset->parameters));
  EXPECT_EQ(*presetText(*preset), presetWith("\"fuzzy.hysteresis\": 0.3"));
}

TEST(PresetFile, readsAnOldVersionAndSaysWhatChanged) {
  const auto preset = loadPreset((data() / "old/version-1.json").string());
  ASSERT_TRUE(preset) << toString(preset.findings());
  EXPECT_EQ(preset->parameters.culling.cullingCase, CullingCase::view_frustum);
  EXPECT_EQ(preset->parameters.lod.screenSpaceError.value(), 4);
  EXPECT_EQ(preset->parameters.scheme.hysteresis.value(), 2.4 / 60);
  EXPECT_EQ(preset->parameters.altitude.curve.point[1], (CurvePoint{5200, 0.55}));
  ASSERT_EQ(preset.findings().size(), 3u);
  for (const Finding& f : preset.findings()) EXPECT_EQ(f.severity, Severity::note);
  EXPECT_TRUE(preset->unknown.empty());
  EXPECT_THAT(*presetText(*preset), HasSubstr("\"version\": 3"));
}

/// Presets of any version may name a way to hidden ground that was withdrawn.
TEST(PresetFile, readsAWithdrawnWayToHiddenGroundAsOneThatStayed) {
  const auto old = loadPreset((data() / "old/version-3-read-back.json").string());
  ASSERT_TRUE(old) << toString(old.findings());
  EXPECT_EQ(old->parameters.culling.occlusion, OcclusionMethod::depth_map);
  ASSERT_EQ(old.findings().size(), 1u);
  EXPECT_THAT(old.findings()[0].where, HasSubstr("version-3-read-back.json:7"));
  EXPECT_EQ(old.findings()[0].found, "read_back, which was withdrawn; depth_map is used");
  for (const std::string way : {"cpu_map", "horizon_and_map"}) {
    const auto preset = parsePreset(presetWith("\"culling.occlusion\": \"" + way + '"'), "p.json");
    ASSERT_TRUE(preset) << toString(preset.findings());
    EXPECT_EQ(preset->parameters.culling.occlusion, OcclusionMethod::horizon);
    ASSERT_EQ(preset.findings().size(), 1u);
    const Finding& note = preset.findings()[0];
    EXPECT_EQ(note.severity, Severity::note);
    EXPECT_EQ(note.key, "culling.occlusion");
    EXPECT_EQ(note.found, way + ", which was withdrawn; horizon is used");
  }
}

TEST(PresetFile, readsTheFormerNameOfTheFormOfTerrain) {
  auto base = loadPreset("as-published");
  ASSERT_EQ(base->parameters.terrain.form, TerrainForm::static_trees);
  const auto preset = loadPreset((data() / "old/version-3-terrain-form.json").string());
  ASSERT_TRUE(preset) << toString(preset.findings());
  EXPECT_EQ(preset->parameters.terrain.form, TerrainForm::tiles) << "not the base's trees";
  ASSERT_EQ(preset.findings().size(), 2u);
  EXPECT_EQ(preset.findings()[0].key, "static_lod.terrain");
  EXPECT_EQ(preset.findings()[1].found, "levels, which was withdrawn; tiles is used");
  EXPECT_THAT(*presetText(*preset), HasSubstr("\"terrain.form\": \"tiles\""));
}

TEST(PresetFile, andAnExportKeptFromItMeanTheSame) {
  const auto preset = loadPreset((data() / "good/everything.json").string());
  const auto exported = loadPreset((data() / "good/export.json").string());
  ASSERT_TRUE(preset && exported) << toString(exported.findings());
  EXPECT_TRUE(sameBits(preset->parameters, exported->parameters));
  EXPECT_EQ(exported->parameters.altitude.curve.point[0].x, 3937.0078740157483);
}

TEST(PresetFile, readsAnExportOfVersion2) {
  TuningParameters expected = loadPreset((data() / "good/everything.json").string())->parameters;
  const auto exported = loadPreset((data() / "old/export-version-2.json").string());
  ASSERT_TRUE(exported) << toString(exported.findings());
  for (const ParameterRow& row : parameterRows())
    if (row.key.starts_with("fuzzy.")) {
      EXPECT_TRUE(sameBits(row.get(exported->parameters), row.get(expected))) << row.key;
    }
}

// Whole exports of as-published, written before presets had a policy, a budget and precipitation of their
// own, and before head motion was as published.
TEST(PresetFile, readsExportsOfVersion3ThatAreOlderThanPolicies) {
  TuningParameters published = loadPreset("as-published")->parameters;
  published.motion = {};
  published.staticLod.error = ErrorMeasure::rms;
  published.staticLod.mapFromTriangles = StaticLodParameters{}.mapFromTriangles;
  for (const char* ending : {"json", "xml", "ini"}) {
    const auto exported = loadPreset((data() / (std::string("old/export-version-3.") + ending)).string());
    ASSERT_TRUE(exported) << toString(exported.findings());
    for (const ParameterRow& row : parameterRows())
      EXPECT_TRUE(sameBits(row.get(exported->parameters), row.get(published))) << ending << ' ' << row.key;
    EXPECT_FALSE(exported->parameters.policy.enabled);
    EXPECT_EQ(exported->parameters.weather.precipitationForm, PrecipitationForm::effect)
        << "as it fell then, not as it falls by default now";
  }
}

/// One mistake a file, named after it: the finding's place, key, and parts of what was expected and found.
struct Bad {
  const char *name, *place, *key, *expected, *found;
};
constexpr Bad kBad[] = {
    {"array-at-top", ":1", "", "an object", "[]"},
    {"bands-falling", ":6", "fuzzy.bands_px", "rising order", "band 2 from 0.1 after 0.5"},
    {"bands-from-top", ":6", "fuzzy.bands_px", "below 2", "band 1 from 2"},
    {"bands-from-zero", ":6", "fuzzy.bands_px", "above 0", "band 1 from 0"},
    {"bands-none", ":6", "fuzzy.bands_px", "1 to 16 bands", "0"},
    {"bands-of-two", ":6", "fuzzy.bands_px", "[low, width, height]", "[0.1, 320]"},
    {"bands-size-not-whole", ":6", "fuzzy.bands_px", "whole numbers", "320.5"},
    {"bands-size-too-small", ":6", "fuzzy.bands_px", "16 to 8192 px", "8x240 px"},
    {"bands-too-many", ":6", "fuzzy.bands_px", "at most 16", "17"},
    {"base-bad", ":4", "base", "a preset file", "scale-too-large.json"},
    {"base-folder", ":4", "base", "a preset file", ".."},
    {"base-itself", ":4", "base", "a preset file", "base-itself.json"},
    {"base-missing", ":4", "base", "a preset file", "nowhere.json"},
    {"choice-as-number", ":6", "fuzzy.combination", "\"sum\", \"twice_minimum\"", "1"},
    {"choice-unknown", ":6", "fuzzy.combination", "\"sum\", \"twice_minimum\"", "average"},
    {"comment", ":6", "", "JSON", "invalid literal"},
    {"curve-beyond-vertical", ":6", "fuzzy.pitch.curve_deg", "-90 to 90", "-100"},
    {"curve-falling", ":6", "fuzzy.altitude.curve_ft", "rising order", "point 2 at 4000 ft after 5000 ft"},
    {"curve-membership-above-one", ":6", "fuzzy.altitude.curve_ft", "0 to 1", "1.5 in point 1"},
    {"curve-not-list", ":6", "fuzzy.pitch.curve_deg", "a list of points", "30"},
    {"curve-one-point", ":6", "fuzzy.pitch.curve_deg", "2 to 32 points", "1"},
    {"curve-point-of-three", ":6", "fuzzy.pitch.curve_deg", "a point [x, y]", "[-30, 1, 2]"},
    {"curve-three-at-one-place", ":6", "fuzzy.altitude.curve_ft", "at most two", "point 3 at 4000 ft"},
    {"curve-too-many-points", ":6", "fuzzy.pitch.curve_deg", "at most 32", "33"},
    {"empty", ":1", "", "JSON", "end of input"},
    {"flag-as-number", ":6", "host.extrapolate", "true or false", "1"},
    {"fractional-version", ":3", "version", "from 1 to 3", "1.5"},
    {"future-version", ":3", "version", "from 1 to 3", "4"},
    {"hysteresis-reaches-zero", ":6", "fuzzy.hysteresis", "first band's edge", "0.1"},
    {"hysteresis-wider-than-band", ":7", "fuzzy.hysteresis", "half the narrowest band", "0.2"},
    {"maximum-below-curve", ":7", "fuzzy.altitude.maximum_ft", "at least 8000 ft", "7500 ft"},
    {"member-twice", ":4", "version", "once", "second time"},
    {"name-not-text", ":4", "name", "text", "7"},
    {"near-zero", ":6", "view.near_m", "0.001 to 1000 m", "0 m"},
    {"no-format", ":1", "format", "trimtab-preset", "none"},
    {"no-parameters", ":1", "parameters", "an object", "none"},
    {"no-version", ":1", "version", "from 1 to 3", "none"},
    {"not-a-number", ":6", "", "JSON", "invalid literal"},
    {"not-json", ":1", "", "JSON", "invalid literal"},
    {"number-as-text", ":6", "lod.scale", "a number", "\"2\""},
    {"number-overflow", ":6", "", "JSON", "number overflow"},
    {"other-format", ":2", "format", "trimtab-preset", "property-list"},
    {"parameter-twice", ":7", "lod.scale", "once", "second time"},
    {"parameters-not-object", ":4", "parameters", "an object", "[]"},
    {"policy-condition-empty", ":6", "policy.rules", "a condition between if and then", "if then"},
    {"policy-condition-unclosed", ":6", "policy.rules", ")", "nothing in rule 1"},
    {"policy-connective-missing", ":6", "policy.rules", "and, or, or the end", "speed in rule 1"},
    {"policy-hedge-unknown", ":6", "policy.rules", "and, or, or the end", "fast in rule 1"},
    {"policy-lever-not-a-number", ":6", "policy.rules", "lod_scale from 0.1 to 16", "nan in rule 1"},
    {"policy-lever-out-of-range", ":6", "policy.rules", "lod_scale from 0.1 to 16", "99 in rule 1"},
    {"policy-lever-twice", ":6", "policy.rules", "each lever once", "lod_scale in rule 1"},
    {"policy-lever-unknown", ":6", "policy.rules", "a lever after then: occlusion", "colour in line 1"},
    {"policy-nested-too-deep", ":6", "policy.rules", "less nesting", "( in rule 1"},
    {"policy-rule-control-character", ":6", "policy.rules", "UTF-8", "a control character in line 1"},
    {"policy-rule-signal-unknown", ":6", "policy.rules", "a signal: altitude", "pressure in rule 1"},
    {"policy-rule-term-unknown", ":6", "policy.rules", "a term of speed: fast", "slow in rule 1"},
    {"policy-rule-too-long", ":6", "policy.rules", "lines of at most 20000", "20038 in line 1"},
    {"policy-rule-too-many-parts", ":6", "policy.rules", "at most 64 terms", "79 in rule 1"},
    {"policy-rules-too-many", ":6", "policy.rules", "at most 1024 lines", "1025"},
    {"policy-term-empty", ":7", "policy.terms", "one of points, triangle", "nothing in line 1"},
    {"policy-term-infinite", ":7", "policy.terms", "from -1e12 to 1e12", "inf in term speed.slow"},
    {"policy-term-name-reserved", ":7", "policy.terms", "no word of rules", "very in term speed.very"},
    {"policy-term-not-a-number", ":7", "policy.terms", "from -1e12 to 1e12", "nan in term speed.slow"},
    {"policy-term-numbers-missing", ":7", "policy.terms", "three numbers", "2 numbers in term speed.slow"},
    {"policy-term-points-falling", ":7", "policy.terms", "from left to right", "5 before 1 in term"},
    {"policy-term-points-three-at-one-place", ":7", "policy.terms", "at most two points", "three at 1 in"},
    {"policy-term-shape-unknown", ":7", "policy.terms", "one of points, triangle", "cosine in line 1"},
    {"policy-term-signal-unknown", ":7", "policy.terms", "a signal: altitude", "\"pressure\" in line 1"},
    {"policy-term-twice", ":7", "policy.terms", "a name that stands once", "fast in term speed.fast"},
    {"policy-term-width-zero", ":7", "policy.terms", "two different numbers", "4 4 in term speed.slow"},
    {"policy-terms-not-list", ":6", "policy.terms", "a list of lines", "\"speed fast"},
    {"policy-weight-above-one", ":6", "policy.rules", "a weight from 0 to 1", "1.5 in rule 1"},
    {"policy-weight-missing", ":6", "policy.rules", "a weight after with", "nothing in line 1"},
    {"policy-weight-negative", ":6", "policy.rules", "a weight from 0 to 1", "-0.5 in rule 1"},
    {"policy-weight-not-a-number", ":6", "policy.rules", "a weight from 0 to 1", "nan in rule 1"},
    {"scale-too-large", ":6", "lod.scale", "0.05 to 100", "101"},
    {"trailing-comma", ":7", "", "JSON", "unexpected '}'"},
    {"truncated", ":6", "", "JSON", "missing closing quote"},
    {"width-not-whole", ":6", "view.width_px", "whole number", "1280.5 px"},
};

TEST(BadPreset, isRefusedWithPlaceExpectedAndFound) {
  for (const Bad& bad : kBad) {
    const std::string file = (data() / "bad" / (std::string(bad.name) + ".json")).string();
    const auto preset = loadPreset(file);
    EXPECT_FALSE(preset && validate(preset->parameters)) << bad.name;
    ASSERT_FALSE(preset.findings().empty()) << bad.name;
    const Finding& f = preset.findings()[0];
    EXPECT_EQ(f.severity, Severity::error);
    EXPECT_EQ(f.where, file + bad.place);
    EXPECT_EQ(f.key, bad.key) << bad.name;
    EXPECT_THAT(f.expected, HasSubstr(bad.expected)) << bad.name;
    EXPECT_THAT(f.found, HasSubstr(bad.found)) << bad.name;
    // A bad base has a second finding, in the base's own file.
    EXPECT_LE(preset.findings().size(), std::string_view(bad.name).starts_with("base") ? 2u : 1u)
        << toString(preset.findings());
  }
}

TEST(BadPreset, hasAFileForEachRowAndARowForEachFile) {
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(data() / "bad")) {
    const std::string name = entry.path().stem().string();
    EXPECT_TRUE(std::any_of(std::begin(kBad), std::end(kBad), [&](const Bad& b) { return name == b.name; }))
        << name;
    ++files;
  }
  EXPECT_EQ(files, std::size(kBad));
}

TEST(BadPreset, thatIsNoFileIsNamed) {
  EXPECT_EQ(toString(loadPreset("no/such.json").findings()),
            "no/such.json: expected a readable file, found No such file or directory");
  EXPECT_THAT(toString(loadPreset("/").findings()), HasSubstr("found a folder"));
}

TEST(BadPreset, mayNestWithoutEnd) {
  const std::string deep = std::string(1000000, '[') + std::string(1000000, ']');
  const auto preset = parsePreset(presetWith("\"future.deep\": " + deep), "memory");
  ASSERT_TRUE(preset);
  EXPECT_EQ(preset->unknown.at("future.deep"), deep);
  EXPECT_FALSE(parsePreset(presetWith("\"lod.scale\": " + deep), "memory"));
  EXPECT_FALSE(parsePreset(std::string(1000000, '['), "memory"));
}

}  // namespace
}  // namespace trimtab
