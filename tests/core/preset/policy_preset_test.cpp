#include <gmock/gmock.h>

#include <chrono>
#include <set>

#include "random_parameters.h"
#include "tests/support.h"
#include "trimtab/policy/policy_file.h"
#include "trimtab/preset/policy_lines.h"
#include "trimtab/preset/preset.h"

namespace trimtab {
namespace {

using ::testing::HasSubstr;

TuningParameters withPolicy(std::vector<std::string> rules) {
  TuningParameters parameters;
  parameters.policy.enabled = true;
  parameters.policy.terms.line = {"speed fast = ramp 200 400", "roll steep = points 20 0 20 1"};
  parameters.policy.rules.line = std::move(rules);
  return parameters;
}

/// Reasons are what people type, and no reason may break a file.
const std::string kReasons[] = {
    "a | b || c|",
    "\\ \\| \\\\ \\n \\",
    "\"quoted\" 'twice' `thrice`",
    "# hash ## # rule: if",
    "<tag> &amp; ]]> <!-- -->",
    "; [section] key = value, x=1",
    "h\xc3\xb6her \xe2\x82\xac \xf0\x9f\x9a\x81",
    "{\"json\": [1, 2]}",
    "if speed is fast then lod_scale = 4",
    "% reason: % rule: 1, 1 (1) : 1",
    std::string(15000, 'x'),
};

TEST(PolicyPreset, comesBackToTheBitFromEveryFormatWhateverItsReasonsSay) {
  std::vector<std::string> rules;
  for (const std::string& reason : kReasons)
    rules.push_back("if speed is fast then lod_scale = 2 with 0.30000000000000004 # " + reason);
  rules.push_back("off if roll is not steep then lod_scale = 1");
  std::string condition = "speed is fast";
  for (int i = 0; i < 31; ++i) condition += " or roll is steep";
  rules.push_back("if " + condition + " then lod_scale = 1");
  const TuningParameters parameters = withPolicy(rules);
  const auto valid = validate(parameters);
  ASSERT_TRUE(valid) << toString(valid.findings());
  for (const ExportFormat format : {ExportFormat::json, ExportFormat::xml, ExportFormat::ini}) {
    const std::string text = exportText(*valid, "n", {}, format);
    const auto read = parsePreset(text, "e");
    ASSERT_TRUE(read) << toString(read.findings());
    EXPECT_EQ(read->parameters.policy, parameters.policy);
    EXPECT_EQ(exportText(*validate(read->parameters), "n", {}, format), text);
  }
  Preset preset;
  preset.parameters = parameters;
  EXPECT_EQ(parsePreset(*presetText(preset), "p")->parameters.policy, parameters.policy);
  for (const char* key : {"policy.terms", "policy.rules"}) {
    const ParameterRow& row = *findRow(key);
    EXPECT_EQ(*parseValue(row, toText(row, row.get(parameters))), row.get(parameters));
  }
}

TEST(PolicyPreset, keepsReasonsOnTheirLineWhateverTheyHold) {
  Policy policy = *policyOf(withPolicy({"if speed is fast then lod_scale = 2"}).policy);
  policy.rules[0].reason = " one\ntwo\r\nthree\tfour\x01\x7f ";
  const PolicyParameters lines = policyLines(policy);
  EXPECT_EQ(lines.rules.line[0], "if speed is fast then lod_scale = 2 # one two  three four");
  TuningParameters parameters;
  parameters.policy = lines;
  EXPECT_TRUE(validate(parameters));
  policy.rules[0].reason = "\n\t ";
  EXPECT_EQ(policyLines(policy).rules.line[0], "if speed is fast then lod_scale = 2");
}

TEST(PolicyPreset, refusesBytesThatNoFileCanHold) {
  for (const char* bytes : {"\xff", "\x80", "\xc3", "\xc0\xaf", "\xe2\x82", "\xe0\x80\x80", "\xed\xa0\x80",
                            "\xf4\x90\x80\x80", "\xf5\x80\x80\x80", "a\tb", "a\nb", "\x7f"}) {
    const auto valid = validate(withPolicy({std::string("if speed is fast then lod_scale = 2 # ") + bytes}));
    ASSERT_FALSE(valid) << bytes;
    ASSERT_EQ(valid.findings().size(), 1u);
    EXPECT_EQ(valid.findings()[0].key, "policy.rules");
    EXPECT_THAT(valid.findings()[0].expected, HasSubstr("UTF-8"));
    EXPECT_THAT(valid.findings()[0].found, HasSubstr("in line 1"));
  }
}

TEST(PolicyPreset, thatIsBrokenIsReadAsADraftAndSaysSoWhetherItIsOnOrOff) {
  for (const bool enabled : {true, false}) {
    TuningParameters parameters =
        withPolicy({"if speed is fast then lod_scale = 2", "if speed is slow then"});
    parameters.policy.enabled = enabled;
    EXPECT_FALSE(validate(parameters));
    Preset preset;
    preset.parameters = parameters;
    const auto read = parsePreset(*presetText(preset), "p.json");
    ASSERT_TRUE(read) << "a draft must survive being saved";
    EXPECT_EQ(read->parameters.policy, parameters.policy);
    ASSERT_EQ(read.findings().size(), 1u) << toString(read.findings());
    EXPECT_EQ(read.findings()[0].key, "policy.rules");
    EXPECT_THAT(read.findings()[0].where, ::testing::StartsWith("p.json:"));
    EXPECT_THAT(read.findings()[0].found, HasSubstr("in line 2"));
  }
}

TEST(PolicyPreset, isNeverSlowHoweverLargeItIs) {
  const std::string million(1000000, 'x');
  const std::vector<std::vector<std::string>> all{
      std::vector<std::string>(10000, "if speed is fast then lod_scale = 2"),
      std::vector<std::string>(1024, "if speed is slow then lod_scale = 2"),
      std::vector<std::string>(1024, million.substr(0, 19000)),
      {million},
      {"if " + std::string(1000000, '(')},
      {"if speed is fast then lod_scale = 2 # " + million},
      {std::string(1000000, '|')},
      {std::string(1000000, '#')}};
  for (const auto& rules : all) {
    const TuningParameters parameters = withPolicy(rules);
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_FALSE(validate(parameters)) << rules[0].substr(0, 40);
    std::string text =
        "{\"format\": \"trimtab-preset\", \"version\": 3, \"parameters\": {\"policy.rules\": [";
    for (const std::string& rule : rules) text += (text.ends_with('[') ? "\"" : ", \"") + rule + "\"";
    const auto read = parsePreset(text + "]}}", "p");
    EXPECT_FALSE(read.findings().empty());
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    // Far from what it takes; what grows with the square takes minutes.
    EXPECT_LT(took.count(), 20) << rules[0].substr(0, 40);
  }
}

/// Files that were kept from every format of presets, from the first.
TEST(PolicyPreset, isEmptyInOldFilesOfEveryFormat) {
  std::set<std::string> versions;
  for (const auto& entry :
       std::filesystem::directory_iterator(test::sourceDir() / "tests/data/presets/old")) {
    const std::string text = test::readFile(entry.path());
    EXPECT_THAT(text, ::testing::Not(HasSubstr("policy."))) << entry.path();
    if (entry.path().extension() == ".json") {
      const std::size_t at = text.find("\"version\": ");
      versions.insert(text.substr(at + 11, 1));
    }
    if (entry.path().filename() == "version-2.json") continue;  // its rule base became a policy
    const auto preset = loadPreset(entry.path().string());
    ASSERT_TRUE(preset) << toString(preset.findings());
    EXPECT_EQ(preset->parameters.policy, PolicyParameters{}) << entry.path();
    const auto valid = validate(preset->parameters);
    ASSERT_TRUE(valid) << toString(valid.findings());
    EXPECT_EQ(valid->policy(), nullptr);
    EXPECT_THAT(*presetText(*preset), ::testing::Not(HasSubstr("policy.")));
  }
  const std::string now = *presetText({});
  const int current = std::stoi(now.substr(now.find("\"version\": ") + 11));
  std::set<std::string> all;
  for (int v = 1; v <= current; ++v) all.insert(std::to_string(v));
  EXPECT_EQ(versions, all);
}

}  // namespace
}  // namespace trimtab
