#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <map>

#include "tests/core/fuzzy/fuzzylite_oracle.h"
#include "tests/core/policy/fis_makers.h"
#include "tests/core/policy/fis_oracle.h"
#include "tests/support.h"
#include "trimtab/policy/compiled_policy.h"
#include "trimtab/policy/policy_file.h"

// Files whose outputs are planes or have shapes, which become constants.
namespace trimtab {
namespace {

using test::FisKind;

RuleFileOptions madeOptions(std::size_t inputs, bool accept) {
  auto mapping = readRuleMapping(std::string("In1 (x)=speed*0.02,In2 (x)=roll*0.2,") +
                                     (inputs > 2 ? "In3 (x)=load*3," : "") + "Out=lod_scale*10-1",
                                 "");
  return {*mapping, accept};
}

struct Stated {
  double most, mean;
};
/// Reads "at most X and on average Y" of the note on the output.
Stated statedBy(const Findings& findings) {
  for (const Finding& f : findings) {
    if (!f.key.starts_with("difference of ")) continue;
    const std::string most = "at most ", mean = "on average ";
    return {std::stod(f.found.substr(f.found.find(most) + most.size())),
            std::stod(f.found.substr(f.found.find(mean) + mean.size()))};
  }
  return {-1, -1};
}

/// Returns the difference of a policy from the file, as fuzzylite computes it, over an even grid.
Stated differenceFromTheFile(const Policy& policy, const std::string& fis, std::size_t inputs) {
  std::vector<std::vector<double>> rows;
  const int side = inputs == 2 ? 101 : 25;
  for (int c = 0; c < (inputs == 2 ? 1 : side); ++c)
    for (int b = 0; b < side; ++b)
      for (int a = 0; a < side; ++a) {
        rows.push_back({10.0 * a / (side - 1), 20.0 * b / (side - 1)});
        if (inputs > 2) rows.back().push_back(30.0 * c / (side - 1));
      }
  std::string error;
  const auto theirs = test::fisByFuzzylite(fis, rows, error);
  EXPECT_EQ(error, "") << fis;
  const auto compiled = compile(policy, "p");
  PolicyDecision decision;
  Stated measured{0, 0};
  int places = 0;
  for (std::size_t i = 0; i < std::min(rows.size(), theirs.size()); ++i) {
    SignalValues flight;
    flight[Signal::speed] = rows[i][0] / 0.02, flight[Signal::roll] = rows[i][1] / 0.2;
    if (inputs > 2) flight[Signal::load] = rows[i][2] / 3;
    compiled->decide(flight, decision);
    const double difference = std::abs(decision.target[Lever::lod_scale] * 10 - 1 - theirs[i][0]);
    if (std::isnan(difference)) continue;
    measured.most = std::max(measured.most, difference);
    measured.mean += difference;
    ++places;
  }
  measured.mean /= places;
  return measured;
}

TEST(OrderZero, statesTheDifferenceThatFuzzyliteFinds) {
  if (!test::fuzzylitePresent()) GTEST_SKIP() << "needs the fuzzylite program";
  std::mt19937_64 random(71);
  for (const FisKind kind : {FisKind::mamdani, FisKind::planes})
    for (std::size_t inputs : {2, 2, 2, 3}) {
      const std::string fis = test::randomFis(kind, inputs, random);
      for (const bool accept : {true, false}) {
        const auto policy = readMatlab(fis, "f.fis", madeOptions(inputs, accept));
        ASSERT_TRUE(policy) << toString(policy.findings()) << fis;
        const Stated stated = statedBy(policy.findings()),
                     measured = differenceFromTheFile(*policy, fis, inputs);
        // The output's range is 100; stated numbers have four digits.
        EXPECT_NEAR(stated.most, measured.most, 0.02) << accept << fis;
        EXPECT_NEAR(stated.mean, measured.mean, 0.005) << accept << fis;
        if (!accept) {
          EXPECT_LE(measured.most, 5.01) << fis;
        }
      }
    }
}

TEST(OrderZero, infersByEachOfMamdanisMethodsAsFuzzyliteDoes) {
  if (!test::fuzzylitePresent()) GTEST_SKIP() << "needs the fuzzylite program";
  struct Methods {
    const char *implication, *aggregation, *defuzzifier;
  };
  for (const Methods& how : {Methods{"prod", "max", "centroid"},
                             {"min", "sum", "centroid"},
                             {"prod", "probor", "centroid"},
                             {"prod", "sum", "bisector"},
                             {"min", "max", "som"},
                             {"min", "max", "lom"}}) {
    std::mt19937_64 random(5);
    std::string fis = test::randomFis(FisKind::mamdani, 2, random);
    for (const auto& [from, to] :
         {std::pair("ImpMethod='min'", std::string("ImpMethod='") + how.implication),
          {"AggMethod='max'", std::string("AggMethod='") + how.aggregation},
          {"DefuzzMethod='centroid'", std::string("DefuzzMethod='") + how.defuzzifier}})
      fis.replace(fis.find(from), std::string(from).size(), to + "'");
    const auto policy = readMatlab(fis, "f.fis", madeOptions(2, true));
    ASSERT_TRUE(policy) << toString(policy.findings());
    const Stated stated = statedBy(policy.findings()), measured = differenceFromTheFile(*policy, fis, 2);
    // A bisector and a maximum are one of a hundred numbers, and rounding may choose the next.
    const double tolerance = std::string(how.defuzzifier) == "centroid" ? 0.02 : 1.001;
    EXPECT_NEAR(stated.most, measured.most, tolerance) << how.defuzzifier;
    EXPECT_NEAR(stated.mean, measured.mean, tolerance / 2) << how.defuzzifier;
  }
}

TEST(OrderZero, measuresRulesWithOrNotAndHedgesAsFuzzyliteDoes) {
  if (!test::fuzzylitePresent()) GTEST_SKIP() << "needs the fuzzylite program";
  for (const FisKind kind : {FisKind::mamdani, FisKind::planes}) {
    std::mt19937_64 random(9);
    std::string fis = test::randomFis(kind, 2, random);
    const auto put = [&fis](const std::string& from, std::size_t length, const std::string& to) {
      ASSERT_NE(fis.find(from), std::string::npos) << from;
      fis.replace(fis.find(from) + from.size() - length, length, to);
    };
    put("OrMethod='", 0, kind == FisKind::planes ? "probor' %" : "max' %");
    put("\n1 1, ", 5, "-1 1.2, ");
    put("\n2 2, ", 5, "2.05 -2.3, ");
    for (const char* rule : {"\n-1 1.2, ", "\n3 2, ", "\n2 1, "}) {
      const std::size_t end = fis.find('\n', fis.find(rule) + 1);
      fis[end - 1] = '2';
    }
    const auto policy = readMatlab(fis, "f.fis", madeOptions(2, true));
    ASSERT_TRUE(policy) << toString(policy.findings()) << fis;
    fis.erase(fis.find(" %"),
              fis.find('\n', fis.find(" %")) - fis.find(" %"));  // fuzzylite reads no comment there
    const Stated stated = statedBy(policy.findings()), measured = differenceFromTheFile(*policy, fis, 2);
    EXPECT_NEAR(stated.most, measured.most, kind == FisKind::planes ? 6e-4 : 0.02) << fis;
    EXPECT_NEAR(stated.mean, measured.mean, kind == FisKind::planes ? 2e-4 : 0.005) << fis;
  }
}

/// One input from 0 to 10 and two rules.
std::string twoRules(const std::string& type, const std::string& first, const std::string& second) {
  return "[System]\nType='" + type + "'\nAndMethod='prod'\n[Input1]\nName='In1 (x)'\nRange=[0 10]\n" +
         "MF1='low':'trimf',[-10 0 10]\nMF2='high':'trimf',[0 10 20]\n[Output1]\nName='Out'\nRange=[0 "
         "100]\nMF1='a':" +
         first + "\nMF2='b':" + second + "\n[Rules]\n1, 1 (1) : 1\n2, 2 (1) : 1\n";
}

RuleFileOptions oneInput(bool accept) {
  return {*readRuleMapping("In1 (x)=speed,Out=lod_scale*10", ""), accept};
}

TEST(OrderZero, takesTheConstantsWhoseGreatestDifferenceIsLeast) {
  const auto read =
      readMatlab(twoRules("sugeno", "'linear',[3 20]", "'constant',[50]"), "f.fis", oneInput(true));
  ASSERT_TRUE(read) << toString(read.findings());
  // By hand, with t = x / 10: the surface is 20 + 30 t + 30 t (1 - t), whose last part is at most 7.5, so the
  // line that is nearest to it is 3.75 higher than the one through its ends.
  EXPECT_NEAR(read->rules[0].settings[0].value, 2.375, 0.01);
  EXPECT_NEAR(read->rules[1].settings[0].value, 5.375, 0.01);
  EXPECT_NEAR(statedBy(read.findings()).most, 3.75, 0.1);
}

bool hasTable(const Findings& findings) {
  return std::any_of(findings.begin(), findings.end(), [](const Finding& f) {
    return f.severity == Severity::warning && f.key == "rules" &&
           f.found.find(" rules of the file were replaced by a table of ") != std::string::npos;
  });
}

TEST(OrderZero, becomesATableAboveOneTwentiethOfTheRangeUnlessItIsAccepted) {
  // By hand as above: with a slope s the difference of the two rules is 10 s / 8 of 100, and that of a table
  // with its third level in the middle a quarter of it.
  for (const auto& [slope, rules] : {std::pair("3.9", 2u), {"4.1", 3u}}) {
    const std::string fis = twoRules("sugeno", "'linear',[" + std::string(slope) + " 20]", "'constant',[50]");
    const auto read = readMatlab(fis, "f.fis", oneInput(false)),
               accepted = readMatlab(fis, "f.fis", oneInput(true));
    ASSERT_TRUE(read) << toString(read.findings());
    ASSERT_TRUE(accepted);
    EXPECT_EQ(read->rules.size(), rules);
    EXPECT_EQ(accepted->rules.size(), 2u);
    EXPECT_EQ(hasTable(read.findings()), rules == 3) << toString(read.findings());
    EXPECT_FALSE(hasTable(accepted.findings()));
    EXPECT_NEAR(statedBy(accepted.findings()).most, std::stod(slope) * 10 / 8, 0.13);
    EXPECT_NEAR(statedBy(read.findings()).most, std::stod(slope) * 10 / 8 / (rules == 3 ? 4 : 1), 0.3);
    EXPECT_EQ(read.findings().back().where, "f.fis:9");
    if (rules == 3) {
      EXPECT_EQ(read.findings()[1].where, "f.fis:15");
      EXPECT_TRUE(read.findings()[1].found.starts_with(
          "the 2 rules of the file were replaced by a table of 3 rules, 3 levels of In1__x_; with constants "
          "they differ from the file by up to 5.2"))
          << read.findings()[1].found;
    }
  }
}

TEST(OrderZero, hasATableThatKeepsItsEndsBeyondTheRange) {
  const auto read =
      readMatlab(twoRules("sugeno", "'linear',[6 20]", "'constant',[50]"), "f.fis", oneInput(false));
  ASSERT_TRUE(read) << toString(read.findings());
  const auto compiled = compile(*read, "p");
  PolicyDecision end, beyond;
  SignalValues flight;
  flight[Signal::speed] = 10;
  compiled->decide(flight, end);
  flight[Signal::speed] = 90;
  compiled->decide(flight, beyond);
  EXPECT_EQ(beyond.target[Lever::lod_scale], end.target[Lever::lod_scale]);
  EXPECT_NEAR(end.target[Lever::lod_scale], 5, 0.5);
}

TEST(OrderZero, isRefusedWhereNoTableComesNear) {
  std::string gap = twoRules("sugeno", "'linear',[9 20]", "'constant',[50]");
  gap.replace(gap.find("[-10 0 10]"), 10, "[-10 0 6]").replace(gap.find("[0 10 20]"), 9, "[7 10 20]");
  // A plane over an input that no rule asks for, beside as many others.
  const auto planeOf = [](int inputs) {
    const char* const names[] = {"speed", "roll", "pitch", "load"};
    std::string text = "[System]\nType='sugeno'\nAndMethod='prod'\n", plane = "[0 4", rule = "1";
    for (int i = 1; i <= inputs; ++i)
      text += "[Input" + std::to_string(i) + "]\nName='" + names[i - 1] + "'\nRange=[0 9]\n" +
              (i == 1 ? "MF1='a':'linsmf',[0 9]\n" : "");
    for (int i = 2; i <= inputs; ++i) {
      rule += " 0";
      if (i > 2) plane += " 0";
    }
    return text + "[Output1]\nName='Out'\nRange=[0 40]\nMF1='b':'linear'," + plane + " 20]\n[Rules]\n" +
           rule + ", 1 (1) : 1\n-" + rule + ", 1 (1) : 1\n";
  };
  const RuleFileOptions onlyOut{*readRuleMapping("Out=lod_scale*10-1", ""), false};
  const auto three = readMatlab(planeOf(3), "f.fis", onlyOut);
  ASSERT_TRUE(three) << toString(three.findings());
  EXPECT_TRUE(hasTable(three.findings()));
  EXPECT_EQ(three->rules.size(), 8u);
  for (const auto& refused :
       {readMatlab(gap, "f.fis", oneInput(false)), readMatlab(planeOf(4), "f.fis", onlyOut)}) {
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.findings().size(), 1u);
    EXPECT_EQ(refused.findings()[0].key, "difference of Out");
    EXPECT_NE(refused.findings()[0].expected.find("or --accept-difference; no table of rules comes so near"),
              std::string::npos)
        << toString(refused.findings());
  }
}

TEST(OrderZero, needsNumbersThatHaveASurface) {
  const auto mapping = readRuleMapping("In1 (x)=speed,Out=lod_scale*10", "");
  struct Fault {
    std::string fis, finding;
  };
  const auto with = [](std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
  };
  const std::string planes = twoRules("sugeno", "'linear',[3 20]", "'constant',[50]"),
                    shapes = twoRules("mamdani", "'trimf',[-30 0 30]", "'trapmf',[40 50 70 80]");
  for (const Fault& each :
       {Fault{with(planes, "[3 20]", "[3 4 20]"), "f.fis:12: term a: expected Constant with one"},
        {with(planes, "[0 10]", "[10 0]"), "f.fis:4: Range: expected [low high] with low"},
        {with(planes, "[-10 0 10]", "[0 0 0]"), "f.fis:7: term low: expected a left foot"},
        {with(shapes, "[0 100]", "[7 7]"), "f.fis:9: Range: expected [low high] with low"},
        {with(shapes, "[-30 0 30]", "[-30 -20 -10]"), "f.fis:12: term a: expected a term within"},
        {with(shapes, "'trimf',[-30", "'constant',[-30"), "f.fis:12: term a: expected a shape"}}) {
    const auto refused = readMatlab(each.fis, "f.fis", {*mapping, true});
    ASSERT_FALSE(refused) << each.finding;
    EXPECT_EQ(toString(refused.findings()).substr(0, each.finding.size()), each.finding);
    EXPECT_EQ(refused.findings().size(), 1u) << toString(refused.findings());
  }
}

/// 48 files of the kinds that people have: 29 of Mamdani's kind, 15 of planes, 4 of constants.
TEST(OrderZero, readsTheFilesThatPeopleHave) {
  std::mt19937_64 random(48);
  int read = 0, kept = 0;
  for (const auto& [kind, count] :
       {std::pair(FisKind::mamdani, 29), {FisKind::planes, 15}, {FisKind::constants, 4}})
    for (int i = 0; i < count; ++i) {
      const std::size_t inputs = 2 + random() % 2;
      const std::string fis = test::randomFis(kind, inputs, random);
      const auto policy = readMatlab(fis, "f.fis", madeOptions(inputs, false));
      read += policy.ok();
      kept += policy.ok() && !hasTable(policy.findings());
      if (policy) continue;
      ASSERT_EQ(policy.findings().size(), 1u);
      EXPECT_EQ(policy.findings()[0].key, "difference of Out") << toString(policy.findings());
    }
  std::printf("of 48 files %d are read, %d of them with their rules\n", read, kept);
  EXPECT_GE(read, 46);
  EXPECT_GE(kept, 26) << "all planes and constants, and others whose greatest difference is made small";
}

TEST(OrderZero, isNeverSlow) {
  std::string text = twoRules("mamdani", "'trimf',[-30 0 30]", "'trapmf',[40 50 70 80]");
  for (int i = 0; i < 1000; ++i) text += "1, 1 (1) : 1\n2, 2 (0.5) : 1\n";
  const std::clock_t begin = std::clock();  // of the processor, whatever else runs on it
  const auto read = readMatlab(text, "f.fis", {*readRuleMapping("In1 (x)=speed,Out=lod_scale*10", ""), true});
  EXPECT_FALSE(read.findings().empty());
  EXPECT_LT(std::clock() - begin, 3 * CLOCKS_PER_SEC);
}

/// What the refusal of each of the small files that real users met begins with; the others are read.
const std::map<std::string, std::string> kRefusedFiles{
    {"cut520.fll", "25: expected key: value, as in a file that is whole; write it again, found r"},
    {"default0.fll", "14: default: expected nan: a lever that no rule sets is neutral"},
    {"disabled.fll", "3: enabled: expected true; remove what is switched off"},
    {"empty_outputs.fis", "38: Rules: expected a term of an output, or no such rule"},
    {"height.fll", "7: terms.altitude.high: expected two numbers"},
    {"nummf.fis", "17: NumMFs: expected 3 terms, as many as follow, found 4"},
    {"numrules.fis", "7: NumRules: expected 3 rules, as many as follow, found 5"},
    {"outrange.fis", "33: term cheap: expected occlusion from 0 to 2, or --map"},
    {"truncated.fll", " rule: expected at least one rule; if the file had some, it is cut"},
    {"unordered.fis",
     "20: terms.altitude.excellent: expected a left foot, two tops and a right foot that rise"},
    {"weight15.fis",
     "38: weight: expected a weight from 0 to 1; divide all weights of the file by the greatest"},
    {"wsum.fll", "13: defuzzifier: expected WeightedAverage TakagiSugeno; change it in the tool"},
    {"wtsum.fis", "12: DefuzzMethod: expected 'wtaver', the weighted average, found wtsum"}};

TEST(OrderZero, leavesNoSmallFileWithoutHelp) {
  TRIMTAB_NEEDS_SHARED("cases/hosts/rules");
  const auto folder = test::sharedDir() / "cases/hosts/rules";
  const auto readIn = [&folder](const std::string& name) {
    return readPolicyFile(test::readFile(folder / name), name,
                          ruleFormatOf(name).value_or(RuleFormat::fuzzylite));
  };
  for (const std::string& name : test::namesIn(folder)) {
    const auto read = readIn(name);
    const auto refused = kRefusedFiles.find(name);
    ASSERT_EQ(read.ok(), refused == kRefusedFiles.end()) << name << toString(read.findings());
    if (read) continue;
    const std::string wanted = name + ":" + refused->second;
    EXPECT_EQ(toString(read.findings()[0]).substr(0, wanted.size()), wanted);
  }
  EXPECT_EQ(*readIn("tippersg_linear.fis"), *readIn("tippersg_constant.fis"));
  for (const char* same : {"bom.fis", "crlf.fis", "base_upper.FIS", "Case.fis"})
    EXPECT_EQ(readIn(same)->rules, readIn("tippersg_constant.fis")->rules) << same;
}

}  // namespace
}  // namespace trimtab
