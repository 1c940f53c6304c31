#include <gmock/gmock.h>
#include <sys/stat.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tests/support.h"
#include "trimtab/preset/preset.h"
#include "trimtab/preset/sealed.h"

namespace trimtab {
namespace {

using nlohmann::json;
using test::Ran;
using ::testing::HasSubstr;
using ::testing::StartsWith;

Ran preset(const std::string& arguments) {
  return test::run("SOURCE_DATE_EPOCH=1700000000 " + test::program("trimtab-cli").string() + " preset " +
                   arguments);
}

std::string bad(const std::string& name) {
  return (test::sourceDir() / "tests/data/presets/bad" / (name + ".json")).string();
}
const std::string kGood = (test::sourceDir() / "tests/data/presets/good/everything.json").string();

TEST(PresetCommand, checksGoodAndBadFilesTogether) {
  const Ran good = preset("check default as-published as-printed " + kGood);
  EXPECT_EQ(good.exitCode, 0) << good.err;
  EXPECT_THAT(good.err, HasSubstr("warning: " + kGood + ":16: future.list"));
  const Ran mixed = preset("check default " + bad("near-zero") + " " + bad("truncated"));
  EXPECT_EQ(mixed.exitCode, 1);
  EXPECT_THAT(mixed.out, HasSubstr("default: good\n"));
  EXPECT_THAT(mixed.err, HasSubstr("error: " + bad("near-zero") +
                                   ":6: view.near_m: expected 0.001 to 1000 m, found 0 m"));
  EXPECT_THAT(mixed.err, HasSubstr(bad("truncated") + ":6: expected JSON"));
}

TEST(PresetCommand, refusesEachBadFileWithPlaceAndExpectation) {
  for (const auto& entry :
       std::filesystem::directory_iterator(test::sourceDir() / "tests/data/presets/bad")) {
    const Ran ran = preset("check " + entry.path().string());
    EXPECT_EQ(ran.exitCode, 1) << entry.path();
    EXPECT_THAT(ran.err, StartsWith("error: " + entry.path().string() + ":")) << entry.path();
    EXPECT_THAT(ran.err, HasSubstr("expected "));
    EXPECT_THAT(ran.err, HasSubstr("found "));
  }
}

TEST(PresetCommand, reportsAsJsonAlone) {
  const Ran ran = preset("check --json default " + bad("near-zero"));
  EXPECT_EQ(ran.exitCode, 1);
  const json report = json::parse(ran.out);
  EXPECT_FALSE(report.at("ok").get<bool>());
  EXPECT_TRUE(report.at("files")[0].at("ok").get<bool>());
  EXPECT_EQ(report.at("files")[1].at("findings")[0].at("key"), "view.near_m");
}

const std::string kPolicy =
    " --set 'policy.terms=above_ground low = ramp 2000 500 | speed fast = sigmoid 300 0.05'"
    " --set 'policy.rules=if above_ground is low and speed is not fast then lod_scale = 2, render_scale = "
    "0.75 with 0.5 # why | off if speed is any then lod_scale = 1' --set policy.enabled=true ";

TEST(PresetCommand, givesPoliciesToFuzzyToolsAndTakesThemBack) {
  const test::ScratchDir dir;
  const std::string whole = (dir / "p.json").string();
  ASSERT_EQ(preset("export default -o " + whole + kPolicy).exitCode, 0);
  const auto policy = loadPreset(whole)->parameters.policy;
  ASSERT_EQ(policy.rules.line.size(), 2u);
  for (const std::string ending : {"fll", "fis"}) {
    const std::string rules = (dir / ("r." + ending)).string(), made = (dir / (ending + ".json")).string();
    const Ran exported = preset("policy export " + whole + " -o " + rules);
    ASSERT_EQ(exported.exitCode, 0) << exported.err;
    EXPECT_EQ(exported.err, "");
    EXPECT_EQ(preset("policy export default -o - --format " + ending + kPolicy).out, test::readFile(rules));
    const Ran imported = preset("policy import " + rules + " --base as-published -o " + made);
    ASSERT_EQ(imported.exitCode, 0) << imported.err;
    const auto loaded = loadPreset(made);
    ASSERT_TRUE(loaded) << toString(loaded.findings());
    EXPECT_EQ(loaded->parameters.policy, policy);
    EXPECT_EQ(loaded->base, "as-published");
    EXPECT_EQ(loaded->parameters.scheme.hysteresis.value(), 0);
  }
  EXPECT_THAT(preset("policy export default -o - --format fll").err,
              HasSubstr("error: default: policy.rules: expected at least one rule, found none"));
  const Ran mixed = preset("policy export default -o - --format fis" + kPolicy +
                           "--set 'policy.rules=if speed is fast or speed is not fast then lod_scale = 2'");
  EXPECT_EQ(mixed.exitCode, 1);
  EXPECT_THAT(mixed.err, HasSubstr("error: default: rules.1: expected each input once, found speed twice"));
  test::writeFile(dir / "bad.fis", "[System]\nType='mamdani'\n");
  EXPECT_THAT(
      preset("policy import " + (dir / "bad.fis").string() + " -o -").err,
      HasSubstr("bad.fis:2: Rules: expected [Rules]; the file may be cut, found the end of the file"));
}

TEST(PresetCommand, importsRulesOfOtherPeopleByAMapping) {
  const test::ScratchDir dir;
  const std::string file = (dir / "fan.fis").string(), made = (dir / "fan.json").string();
  test::writeFile(file,
                  "[System]\nType='sugeno'\nAndMethod='prod'\n[Input1]\nName='v (m/s)'\nRange=[0 100]\n"
                  "MF1='slow':'linzmf',[20 80]\n[Output1]\nName='Out'\nRange=[0 60]\n"
                  "MF1='some':'linear',[0.6 12]\nMF2='much':'constant',[50]\n"
                  "[Rules]\n1, 1 (1) : 1\n-1, 2 (1) : 1\n");
  const std::string import = "policy import " + file + " -o " + made;
  const Ran unmapped = preset(import);
  EXPECT_EQ(unmapped.exitCode, 1);
  EXPECT_THAT(unmapped.err, HasSubstr("error: " + file +
                                      ":4: input: expected the key of a signal, or --map "
                                      "\"v__m_s_=KEY*SCALE+OFFSET\" with one of altitude (ft)"));
  const std::string mapped = import + " --map 'v (m/s)=speed*0.514,Out=lod_scale*10'";
  const Ran table = preset(mapped);
  EXPECT_EQ(table.exitCode, 0);
  EXPECT_THAT(table.err, HasSubstr("warning: " + file +
                                   ":14: rules: found the 2 rules of the file were replaced by a table of 3 "
                                   "rules, 3 levels of v__m_s_"));
  EXPECT_EQ(loadPreset(made)->parameters.policy.rules.line.size(), 3u);
  const Ran accepted = preset(mapped + " --accept-difference");
  EXPECT_EQ(accepted.exitCode, 0) << accepted.err;
  EXPECT_THAT(accepted.err, HasSubstr("note: " + file + ":8: difference of Out: found at most "));
  const auto loaded = loadPreset(made);
  ASSERT_TRUE(loaded) << toString(loaded.findings());
  EXPECT_TRUE(loaded->parameters.policy.enabled);
  ASSERT_EQ(loaded->parameters.policy.rules.line.size(), 2u);
  EXPECT_THAT(loaded->parameters.policy.rules.line[1],
              testing::StartsWith("if speed is not slow then lod_scale = "));
  const Ran wrong = preset(import + " --map 'Out=lod_scale*0'");
  EXPECT_THAT(wrong.err,
              HasSubstr("error: --map: expected VARIABLE=KEY*SCALE+OFFSET with a scale that is not 0"));
}

TEST(PresetCommand, refusesRuleFilesWithLineExpectedAndFound) {
  const test::ScratchDir dir;
  const std::string file = (dir / "r.fll").string();
  test::writeFile(file, "Engine: x\nInputVariable: altitude\n  enabled: maybe\n");
  const Ran ran = preset("policy import " + file + " -o -");
  EXPECT_EQ(ran.exitCode, 1);
  EXPECT_EQ(ran.out, "");
  EXPECT_THAT(
      ran.err,
      HasSubstr("error: " + file +
                ":3: enabled: expected true; remove what is switched off, or switch it on, found maybe"));
  EXPECT_EQ(preset("policy import " + file + "x -o -").exitCode, 2) << "which language?";
}

TEST(PresetCommand, exportsWhatTheLibraryLoads) {
  const test::ScratchDir dir;
  const std::string out = (dir / "e.json").string();
  const Ran ran = preset(
      "export " + kGood + " --format json -o " + out +
      " --set fuzzy.hysteresis=0.125 --set 'view.near_m=10 ft' --author me --terrain T --comment 'x y'");
  ASSERT_EQ(ran.exitCode, 0) << ran.err;
  const auto loaded = loadPreset(out);
  ASSERT_TRUE(loaded) << toString(loaded.findings());
  EXPECT_EQ(loaded->parameters.scheme.hysteresis.value(), 0.125);
  EXPECT_DOUBLE_EQ(loaded->parameters.view.nearDistance.value(), 3.048);
  EXPECT_EQ(loaded->parameters.view.width.value(), 1920);
  const json exported = json::parse(test::readFile(out));
  EXPECT_EQ(exported.at("provenance").at("created"), "2023-11-14T22:13:20Z");
  EXPECT_EQ(exported.at("provenance").at("author"), "me");
  EXPECT_EQ(preset("check " + out).exitCode, 0);
}

TEST(PresetCommand, exportsEachFormatWithAChecksumThatCheckVerifies) {
  const test::ScratchDir dir;
  for (const std::string format : {"json", "xml", "ini"}) {
    const std::string out = (dir / format).string();
    ASSERT_EQ(preset("export as-published --format " + format + " -o " + out).exitCode, 0);
    std::string text = test::readFile(out);
    EXPECT_TRUE(checkSeal(text, out));
    EXPECT_EQ(preset("check " + out).exitCode, 0);
    EXPECT_EQ(preset("export as-published --format " + format + " -o -").out, text);
    text[text.size() / 2] = static_cast<char>(text[text.size() / 2] ^ 1);
    test::writeFile(out, text);
    EXPECT_EQ(preset("check " + out).exitCode, 1) << format;
  }
}

TEST(PresetCommand, exportsByTheFilesEndingAndWarnsOfAnother) {
  const test::ScratchDir dir;
  const auto begins = [&dir](const std::string& name) { return test::readFile(dir / name).substr(0, 1); };
  const auto exported = [&dir](const std::string& name, const std::string& options = "") {
    const Ran ran = preset("export as-published " + options + " -o " + (dir / name).string());
    EXPECT_EQ(ran.exitCode, 0) << ran.err;
    return ran.err;
  };
  EXPECT_EQ(exported("a.json") + exported("a.xml") + exported("a.ini") + exported("a"), "");
  EXPECT_EQ(begins("a.json") + begins("a.xml") + begins("a.ini") + begins("a"), "{<;{");
  EXPECT_THAT(exported("a.foo"), HasSubstr("a.foo: expected the ending .json, or .xml or .ini, or --format, "
                                           "found .foo; written as json"));
  EXPECT_EQ(begins("a.foo"), "{");
  EXPECT_THAT(exported("b.json", "--format xml"), HasSubstr("expected the ending .xml, as --format says"));
  EXPECT_EQ(begins("b.json"), "<");
}

TEST(PresetCommand, leavesTheOldExportWhenItRefuses) {
  const test::ScratchDir dir;
  const std::string out = (dir / "e.json").string();
  test::writeFile(out, "old");
  const std::pair<std::string, std::string> refused[] = {
      {"default --set lod.scale=0", "error: default: lod.scale: expected 0.05 to 100, found 0"},
      {"default --set lod.scale=x", "error: --set: lod.scale: expected a number"},
      {"default --set lod.scala=1", "found lod.scala=1"},
      {"default --set lod.scale", "expected key=value"},
      {"default --set fuzzy.hysteresis=0.3", "expected less than 0.2, half the narrowest band"},
      {bad("near-zero"), "view.near_m"},
      {"nowhere.json", "nowhere.json: expected a readable file, found No such file"}};
  for (const auto& [arguments, message] : refused) {
    const Ran ran = preset("export " + arguments + " -o " + out);
    EXPECT_EQ(ran.exitCode, 1) << arguments;
    EXPECT_THAT(ran.err, HasSubstr(message));
    EXPECT_EQ(test::readFile(out), "old");
  }
  EXPECT_THAT(preset("export default -o /dev/full").err, HasSubstr("/dev/full: expected room"));
  EXPECT_EQ(preset("export default -o /dev/full").exitCode, 1);
  EXPECT_EQ(preset("export default -o " + (dir / "no/e.json").string()).exitCode, 1);
}

TEST(PresetCommand, saysInAnExportWhatDependsOnTheMachine) {
  const test::ScratchDir dir;
  const std::string file = (dir / "e.json").string();
  const test::Ran ran = preset("export default -o " + file + " --comment Mine. --terrain Kansai");
  ASSERT_EQ(ran.exitCode, 0) << ran.err;
  EXPECT_THAT(ran.err, HasSubstr("note: default: culling.occlusion: expected a method by name"));
  EXPECT_THAT(test::readFile(file), HasSubstr("Mine. culling.occlusion is auto"));
  const test::Ran pinned = preset("export default -o " + file + " --set culling.occlusion=horizon");
  EXPECT_EQ(pinned.err, "");
  EXPECT_THAT(test::readFile(file), ::testing::Not(HasSubstr("is auto")));
}

TEST(PresetCommand, waitsForNoPipeThatNobodyFills) {
  const test::ScratchDir dir;
  const std::string pipe = (dir / "pipe").string();
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  for (const std::string& command :
       {"check " + pipe, "diff default " + pipe, "policy import " + pipe + " --format fll -o -"}) {
    const Ran ran = test::run("timeout 20 " + test::program("trimtab-cli").string() + " preset " + command);
    EXPECT_EQ(ran.exitCode, 1) << command;
    EXPECT_THAT(ran.err, HasSubstr("a pipe that ends")) << command;
  }
}

TEST(PresetCommand, leavesWhatOthersPutBesideAnExport) {
  const test::ScratchDir dir;
  const std::string backup = (dir / ".e.json.trimtab-backup").string();
  test::writeFile(backup, "mine");
  for (const char* turn : {"new", "replaced"}) {
    const Ran ran = preset("export default -o " + (dir / "e.json").string());
    EXPECT_EQ(ran.exitCode, 0) << turn << ran.err;
    EXPECT_THAT(ran.err, HasSubstr("warning: " + backup)) << turn;
    EXPECT_EQ(test::readFile(backup), "mine") << turn;
  }
  EXPECT_EQ(test::namesIn(dir.path()).size(), 2u);
}

TEST(PresetCommand, exportsToNoPipeThatNobodyReads) {
  const test::ScratchDir dir;
  const std::string pipe = (dir / "pipe").string();
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const std::string command =
      "timeout 20 " + test::program("trimtab-cli").string() + " preset export default -o " + pipe;
  const Ran alone = test::run(command);
  EXPECT_EQ(alone.exitCode, 1);
  EXPECT_THAT(alone.err, HasSubstr(pipe + ": expected a pipe that somebody reads"));
  const Ran read = test::run("exec 3<>" + pipe + "; " + command + " && head -c 1 <&3");
  EXPECT_EQ(read.exitCode, 0) << read.err;
  EXPECT_EQ(read.out, "{");
}

/// `ulimit -f` has the system end a program by a signal, unless it ignores that.
TEST(PresetCommand, saysWhenAFileMayNotBeSoLarge) {
  const test::ScratchDir dir;
  test::writeFile(dir / "e.json", "old");
  const Ran ran = test::run("ulimit -f 8; " + test::program("trimtab-cli").string() +
                            " preset export default -o " + (dir / "e.json").string());
  EXPECT_EQ(ran.exitCode, 1);
  EXPECT_THAT(ran.err, HasSubstr("File too large"));
  EXPECT_EQ(test::readFile(dir / "e.json"), "old");
}

TEST(TrimtabCli, waitsForNoPipeAsTerrainOrResults) {
  const test::ScratchDir dir;
  const std::string pipe = (dir / "pipe").string();
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  for (const auto& [command, found] :
       {std::pair{"terrain bake " + pipe + " -o " + (dir / "db").string(), "a pipe or a device"},
        {"terrain bake /dev/zero -o " + (dir / "db").string(), "found a device"},
        {"results " + pipe, "a pipe that ends"}}) {
    const Ran ran = test::run("timeout 20 " + test::program("trimtab-cli").string() + " " + command);
    EXPECT_EQ(ran.exitCode, 1) << command;
    EXPECT_THAT(ran.err, HasSubstr(found)) << command;
  }
}

TEST(PresetCommand, saysWhenStandardOutputIsFull) {
  const std::string cli = test::program("trimtab-cli").string();
  for (const char* command :
       {"preset check default", "preset check --json default", "preset diff default as-published",
        "preset schema", "preset export default -o -", "preset --help", "--version",
        "decide --altitude-ft 5000 --pitch-deg 0"}) {
    const Ran ran = test::run("( " + cli + " " + command + " >/dev/full )");
    EXPECT_EQ(ran.exitCode, 1) << command << '\n' << ran.err;
    EXPECT_THAT(ran.err, HasSubstr("standard output: expected to be written to the end")) << command;
  }
}

TEST(PresetCommand, repairsABrokenRuleBySet) {
  EXPECT_EQ(preset("export " + bad("hysteresis-reaches-zero") + " -o - --set fuzzy.hysteresis=0.01").exitCode,
            0);
}

TEST(PresetCommand, listsDifferences) {
  const Ran text = preset("diff default as-published");
  EXPECT_EQ(text.exitCode, 0);
  EXPECT_THAT(text.out,
              StartsWith("fuzzy.pitch.reading: linear -> rounded_step\nfuzzy.hysteresis: 0.05 -> 0\n"));
  const json found = json::parse(preset("diff --json default as-published").out);
  EXPECT_EQ(found.at("differences").size(),
            static_cast<std::size_t>(std::count(text.out.begin(), text.out.end(), '\n')));
  EXPECT_EQ(found.at("differences")[1],
            (json{{"key", "fuzzy.hysteresis"}, {"left", "0.05"}, {"right", "0"}}));
  EXPECT_EQ(preset("diff default default").out, "");
  EXPECT_EQ(preset("diff default " + bad("no-format")).exitCode, 1);
}

TEST(PresetCommand, printsSchemaAndReference) {
  EXPECT_EQ(preset("schema").out, presetSchema());
  EXPECT_EQ(preset("reference").out, parameterReference());
}

TEST(PresetCommand, tellsWrongUsageFromBadInput) {
  for (const char* const usage : {"", "check", "export default", "export default -o x --format yaml",
                                  "diff default", "frob", "check --frob default"})
    EXPECT_EQ(preset(usage).exitCode, 2) << usage;
  EXPECT_EQ(preset("--help").exitCode, 0);
  EXPECT_EQ(preset("export --help").exitCode, 0);
}

}  // namespace
}  // namespace trimtab
