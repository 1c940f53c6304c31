#include <gmock/gmock.h>

#include "tests/core/rig/profiles.h"
#include "trimtab/preset/policy_lines.h"
#include "trimtab/preset/preset.h"
#include "trimtab/preset/rules.h"
#include "trimtab/rig/limited_preset.h"

namespace trimtab {
namespace {

using test::viewer;
using testing::HasSubstr;

constexpr double kInf = std::numeric_limits<double>::infinity(),
                 kNan = std::numeric_limits<double>::quiet_NaN();

LeverChain chainOf(FrameLevers drawn) {
  LeverChain chain;
  chain.drawn = drawn;
  return chain;
}

TEST(IgProfile, hasTheLeversOfItsFile) {
  const IgProfile p = viewer();
  ASSERT_EQ(p.levers.size(), 2u);
  EXPECT_EQ(p.levers[0].names().key, "lod_scale") << "they are in the order of the levers";
  EXPECT_EQ(p.find("render_scale"), nullptr);
  EXPECT_EQ(p.errorLever(), p.find("lod_scale"));
  EXPECT_EQ(p.find("far_distance")->ownUnit, "km");
  EXPECT_DOUBLE_EQ(p.find("far_distance")->neutral(), 80000);
  EXPECT_DOUBLE_EQ(p.find("far_distance")->ours().low, 5000);
  EXPECT_EQ(p.load, IgLoad::triangles);
}

TEST(IgProfile, speaksTheUnitsOfTheImageGenerator) {
  const IgProfile p = viewer();
  FrameLevers drawn;
  drawn.farM = 20000;
  drawn.lodScale = 1.5;
  drawn.errorPx = 4;  // twice the preset's
  EXPECT_DOUBLE_EQ(ownValue(p, *p.find("far_distance"), chainOf(drawn)), 20);
  EXPECT_DOUBLE_EQ(ownValue(p, *p.find("lod_scale"), chainOf(drawn)), 3);
  drawn = {};
  EXPECT_DOUBLE_EQ(ownValue(p, *p.find("far_distance"), chainOf(drawn)), 80)
      << "an unlimited distance is its largest";
  drawn.lodScale = 100;
  drawn.farM = 1;
  EXPECT_DOUBLE_EQ(ownValue(p, *p.find("lod_scale"), chainOf(drawn)), 8);
  EXPECT_DOUBLE_EQ(ownValue(p, *p.find("far_distance"), chainOf(drawn)), 5);
  drawn.lodScale = kNan;
  EXPECT_DOUBLE_EQ(ownValue(p, *p.find("lod_scale"), chainOf(drawn)), 1);
}

TEST(IgProfile, ofAnInverseLeverFallsWhereOursRises) {
  const Result<IgProfile> p = parseIgProfile(
      R"({"format": "trimtab-ig-profile", "version": 1, "name": "bias", "levers":
         {"lod_scale": {"key": "LodBias", "factor": 2, "inverse": true, "from": 0.25, "to": 4, "neutral": 2}}})",
      "p");
  ASSERT_TRUE(p.ok()) << toString(p.findings());
  const IgLever& lever = p->levers[0];
  EXPECT_DOUBLE_EQ(lever.neutral(), 1);
  EXPECT_DOUBLE_EQ(lever.ours().low, 0.5);
  EXPECT_DOUBLE_EQ(lever.ours().high, 8);
  EXPECT_DOUBLE_EQ(lever.toOwn(4), 0.5);
  EXPECT_DOUBLE_EQ(lever.toOwn(0), 4);
  EXPECT_DOUBLE_EQ(lever.toOwn(kInf), 0.25);
}

TEST(IgProfile, countsTheLoadThatTheImageGeneratorReports) {
  IgProfile p = viewer();
  EXPECT_EQ(loadOf(p, 100, 20, 3), 100);
  p.load = IgLoad::objects;
  EXPECT_EQ(loadOf(p, 100, 20, 3), 20);
  p.load = IgLoad::time;
  EXPECT_EQ(loadOf(p, 100, 20, 3), 3000);
  EXPECT_EQ(loadOf(p, 100, 20, kNan), 0);
}

TEST(IgProfile, ofBadInputIsRefusedByLineAndKey) {
  struct Case {
    const char *levers, *key, *found;
  };
  const std::string head =
      "{\"format\": \"trimtab-ig-profile\", \"version\": 1, \"name\": \"x\",\n\"levers\": {\n";
  for (
      const Case& c :
      {Case{R"("lodscale": {"from": 1, "to": 2, "neutral": 1})", "levers.lodscale", "lodscale"},
       {R"("lod_scale": {"from": 2, "to": 2, "neutral": 2})", "levers.lod_scale", "2 and 2"},
       {R"("lod_scale": {"from": 1, "to": 2, "neutral": 3})", "levers.lod_scale", "3"},
       {R"("lod_scale": {"from": 1, "to": 2})", "levers.lod_scale", "not all of them"},
       {R"("lod_scale": {"from": 1, "to": 1e300, "neutral": 1})", "levers.lod_scale.to", "1e300"},
       {R"("lod_scale": {"from": 1, "to": 2, "neutral": "1"})", "levers.lod_scale.neutral", "\"1\""},
       {R"("lod_scale": {"from": 1, "to": 2, "neutral": 1, "factor": 0})", "levers.lod_scale.factor", "0"},
       {R"("lod_scale": {"from": 0, "to": 2, "neutral": 0})", "levers.lod_scale", "0"},
       {R"("lod_scale": {"from": 1, "to": 2, "neutral": 1, "inverse": 1})", "levers.lod_scale.inverse", "1"},
       {R"("far_distance": {"from": 0, "to": 2, "neutral": 1, "inverse": true})", "levers.far_distance", "0"},
       {R"("lod_scale": {"from": 1, "to": 2, "neutral": 1}, "lod_scale": {"from": 1, "to": 2, "neutral": 1})",
        "levers.lod_scale", "it again"}}) {
    const Result<IgProfile> p = parseIgProfile(head + c.levers + "}}", "p.json");
    ASSERT_FALSE(p.ok()) << c.levers;
    const Finding& first = p.findings().front();
    EXPECT_EQ(first.where, "p.json:3") << c.levers;
    EXPECT_EQ(first.key, c.key);
    EXPECT_EQ(first.found, c.found);
  }
  EXPECT_FALSE(parseIgProfile(head + "}}", "p").ok()) << "it has no lever";
  constexpr const char* kNameless =
      R"({"format": "trimtab-ig-profile", "levers": {"lod_scale": {"from": 1, "to": 2, "neutral": 1}}})";
  const Findings nameless = parseIgProfile(kNameless, "p").findings();
  ASSERT_EQ(nameless.size(), 2u);
  EXPECT_EQ(nameless[0].key, "version");
  EXPECT_EQ(nameless[1].key, "name");
  EXPECT_FALSE(parseIgProfile("{\"format\": \"trimtab-preset\"}", "p").ok());
  EXPECT_FALSE(parseIgProfile("{", "p").ok());
  EXPECT_FALSE(loadIgProfile("/nowhere/p.json").ok());
}

TuningParameters presetOf(std::vector<std::string> terms, std::vector<std::string> rules) {
  TuningParameters p;
  p.policy.enabled = true;
  p.policy.terms.line = std::move(terms);
  p.policy.rules.line = std::move(rules);
  return p;
}

TEST(LimitedPreset, decidesNothingThatTheImageGeneratorLacks) {
  const TuningParameters preset = presetOf(
      {"altitude low = ramp 5000 1000"},
      {"if altitude is low then lod_scale = 12, render_scale = 0.7 # both",
       "off if altitude is low then blur_strength = 0", "if altitude is low then screen_space_error = 64"});
  const Result<TuningParameters> limited = limitedTo(viewer(), preset, "preset");
  ASSERT_TRUE(limited.ok());
  EXPECT_THAT(limited->policy.rules.line,
              testing::ElementsAre("if altitude is low then lod_scale = 8 # both",
                                   "if altitude is low then screen_space_error = 16"));
  EXPECT_EQ(limited->motion.blurStrength.value(), 0);
  EXPECT_EQ(limited->motion.lodMaximum, preset.motion.lodMaximum);
  EXPECT_EQ(limited->hold.renderScaleMinimum.value(), 1);
  EXPECT_EQ(limited->hold.particlesMinimum.value(), 1);
  EXPECT_EQ(limited->hold.blurMinimum.value(), 1);
  EXPECT_EQ(limited->hold.errorMaximum.value(), 16);
  EXPECT_EQ(limited->culling.cullingCase, CullingCase::view_frustum);
  for (const char* key :
       {"policy.rules.1", "policy.rules.2", "policy.rules.3", "motion.blur_strength", "culling.case"})
    EXPECT_TRUE(std::ranges::any_of(limited.findings(), [&](const Finding& f) { return f.key == key; }))
        << key;
  EXPECT_TRUE(validate(*limited).ok());
}

TEST(LimitedPreset, withEveryLeverStaysAsItIs) {
  IgProfile all;
  for (std::size_t row = 0; row < kFrameLeverRows.size(); ++row)
    all.levers.push_back({row, "own", "", 1, false, {0, 1e9}, 1});
  for (const std::string_view name : shippedPresets()) {
    const TuningParameters preset = loadPreset(std::string(name))->parameters;
    const Result<TuningParameters> limited = limitedTo(all, preset, "preset");
    EXPECT_TRUE(limited.findings().empty()) << name << '\n' << toString(limited.findings());
    EXPECT_TRUE(differences(preset, *limited).empty()) << name;
  }
}

TEST(LimitedPreset, ofEveryShippedOneIsValidForEachSingleLever) {
  for (std::size_t row = 0; row < kFrameLeverRows.size(); ++row) {
    IgProfile one;
    one.levers.push_back({row, "own", "", 1, false, {0.5, 4}, 1});
    for (const std::string_view name : shippedPresets()) {
      const Result<TuningParameters> limited =
          limitedTo(one, loadPreset(std::string(name))->parameters, "preset");
      ASSERT_TRUE(limited.ok());
      const auto valid = validate(*limited);
      EXPECT_TRUE(valid.ok()) << name << ' ' << kFrameLeverRows[row].key << '\n'
                              << toString(valid.findings());
      const Result<Policy> policy = policyOf(limited->policy);
      ASSERT_TRUE(policy.ok());
      for (const PolicyRule& rule : policy->rules)
        for (const LeverSetting& s : rule.settings) EXPECT_TRUE(follows(one, s.lever)) << name;
    }
  }
}

}  // namespace
}  // namespace trimtab
