#include "trimtab/policy/rule_file.h"

#include <gtest/gtest.h>

#include "trimtab/policy/policy_file.h"

namespace trimtab {
namespace {

/// Two inputs, and planes whose slope over the first input is `slope`.
std::string planes(double slope, const std::string& first = "Knots", const std::string& out = "Out") {
  const std::string a = std::to_string(slope);
  return "[System]\nName='m'\nType='sugeno'\nVersion=2.0\nNumInputs=2\nNumOutputs=1\nNumRules=2\n"
         "AndMethod='prod'\nOrMethod='probor'\nImpMethod='prod'\nAggMethod='sum'\nDefuzzMethod='wtaver'\n"
         "[Input1]\nName='" +
         first +
         "'\nRange=[0 300]\nNumMFs=2\nMF1='slow':'trimf',[-300 0 300]\n"
         "MF2='fast':'trimf',[0 300 600]\n[Input2]\nName='roll'\nRange=[-60 60]\nNumMFs=1\n"
         "MF1='level':'trapmf',[-200 -100 100 200]\n[Output1]\nName='" +
         out +
         "'\nRange=[0 10]\nNumMFs=2\n"
         "MF1='few':'linear',[" +
         a +
         " 0 2]\nMF2='many':'linear',[0 0 6]\n"
         "[Rules]\n1 1, 1 (1) : 1\n2 1, 2 (1) : 1\n";
}

TEST(RuleFile, saysWhatItsVariablesAreAndWhatTheirNamesTell) {
  const auto file = RuleFile::open(planes(0, "Speed", "lod_scale"), "m.fis", RuleFormat::matlab);
  ASSERT_TRUE(file) << toString(file.findings());
  ASSERT_EQ(file->inputs().size(), 2U);
  EXPECT_EQ(file->inputs()[0].name, "Speed");
  EXPECT_EQ(file->inputs()[0].key, "speed");
  EXPECT_EQ(file->inputs()[1].range.low, -60);
  EXPECT_EQ(file->outputs()[0].key, "lod_scale");
  const auto other = RuleFile::open(planes(0), "m.fis", RuleFormat::matlab);
  EXPECT_EQ(other->inputs()[0].key, "");
  EXPECT_EQ(other->outputs()[0].key, "");
  EXPECT_FALSE(RuleFile::open("[System]\nName='x'\n", "m.fis", RuleFormat::matlab));
}

TEST(RuleFile, makesThePolicyThatReadPolicyFileMakesAsOftenAsAsked) {
  const std::string text = planes(0.0001);
  const auto file = RuleFile::open(text, "m.fis", RuleFormat::matlab);
  ASSERT_TRUE(file);
  for (const char* map : {"Knots=speed,Out=lod_scale", "Knots=speed*2,Out=lod_scale*3+1",
                          "Knots=altitude*0.01+5,Out=screen_space_error*2"}) {
    const auto mapping = readRuleMapping(map, "");
    const auto once = readPolicyFile(text, "m.fis", RuleFormat::matlab, {*mapping, false});
    const auto again = file->policy(*mapping, false);
    ASSERT_EQ(once.ok(), again.ok()) << map;
    EXPECT_EQ(toString(once.findings()), toString(again.findings())) << map;
    if (!once) continue;
    EXPECT_EQ(*toFuzzyLite(*once, "m"), *toFuzzyLite(*again, "m")) << map;
  }
  EXPECT_FALSE(file->policy({}, false));
  EXPECT_TRUE(mappingMayHelp(file->policy({}, false).findings()));
  EXPECT_FALSE(file->acceptMatters()) << toString(file->differences(false));
}

TEST(RuleFile, asksWhetherItsDifferenceIsAccepted) {
  const auto file = RuleFile::open(planes(0.02), "m.fis", RuleFormat::matlab);
  ASSERT_TRUE(file);
  EXPECT_TRUE(file->acceptMatters()) << toString(file->differences(false));
  const auto mapping = readRuleMapping("Knots=speed,Out=lod_scale", "");
  const auto accepted = file->policy(*mapping, true);
  ASSERT_TRUE(accepted) << toString(accepted.findings());
  EXPECT_EQ(accepted->rules.size(), 2U) << "the rules of the file";
  EXPECT_NE(toString(file->differences(true)).find("difference of Out: found at most "), std::string::npos)
      << toString(file->differences(true));
}

TEST(RuleFile, knowsWhatAMappingDoesNotMend) {
  std::string text = planes(0);
  text.replace(text.find("AndMethod='prod'"), 16, "AndMethod='ham1'");
  const auto file = RuleFile::open(text, "m.fis", RuleFormat::matlab);
  const auto mapping = readRuleMapping("Knots=speed,Out=lod_scale", "");
  const Findings findings = file ? file->policy(*mapping, true).findings() : file.findings();
  EXPECT_TRUE(hasError(findings));
  EXPECT_FALSE(mappingMayHelp(findings)) << toString(findings);
  // Values beyond the lever's range are a matter of scale.
  const auto good = RuleFile::open(planes(0), "m.fis", RuleFormat::matlab);
  const auto far = readRuleMapping("Knots=speed,Out=lod_scale*0.0001", "");
  EXPECT_TRUE(mappingMayHelp(good->policy(*far, false).findings()));
}

}  // namespace
}  // namespace trimtab
