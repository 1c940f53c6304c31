#include <gtest/gtest.h>

#include <cmath>

#include "tests/core/fuzzy/fuzzylite_oracle.h"
#include "tests/core/policy/fis_oracle.h"
#include "tests/support.h"
#include "trimtab/policy/compiled_policy.h"
#include "trimtab/policy/policy_file.h"

// MATLAB's files as people have them, which this program did not write.
namespace trimtab {
namespace {

const std::string kDescent =
    "[System]\n"
    "Name='descent'\n"
    "Type='sugeno'\n"
    "NumInputs=2\n"
    "NumOutputs=1\n"
    "NumRules=3\n"
    "AndMethod='min'\n"
    "OrMethod='max'\n"
    "DefuzzMethod='wtaver'\n"
    "[Input1]\n"
    "Name='speed'\n"
    "Range=[0 600]\n"
    "NumMFs=2\n"
    "MF1='slow':'trapmf',[-10 0 120 300]\n"
    "MF2='fast':'trimf',[200 420 700]\n"
    "[Input2]\n"
    "Name='roll'\n"
    "Range=[0 90]\n"
    "NumMFs=2\n"
    "MF1='level':'gaussmf',[14 0]\n"
    "MF2='steep':'gaussmf',[20 80]\n"
    "[Output1]\n"
    "Name='lod_scale'\n"
    "Range=[1 8]\n"
    "NumMFs=3\n"
    "MF1='fine':'constant',[1.25]\n"
    "MF2='middle':'constant',[3]\n"
    "MF3='coarse':'constant',[7.5]\n"
    "[Rules]\n"
    "1 1, 1 (1) : 1\n"
    "2 1, 2 (0.75) : 1\n"
    "0 2, 3 (1) : 1\n";

struct Change {
  std::string from, to;
};
std::string descentWith(const std::vector<Change>& changes) {
  std::string text = kDescent;
  for (const Change& change : changes) {
    const std::size_t at = text.find(change.from);
    EXPECT_NE(at, std::string::npos) << change.from;
    text.replace(at, change.from.size(), change.to);
  }
  return text;
}

/// Returns the policy's lod_scale over the grid of the file's ranges, and the rows of the grid.
std::vector<double> surfaceOf(const Policy& policy, std::vector<std::vector<double>>* rows = nullptr) {
  const auto compiled = compile(policy, "p");
  EXPECT_TRUE(compiled) << toString(compiled.findings());
  std::vector<double> values;
  PolicyDecision decision;
  for (double speed = 7; speed < 600; speed += 23)
    for (double roll = 1.5; roll < 90; roll += 6) {
      SignalValues signals;
      signals[Signal::speed] = speed, signals[Signal::roll] = roll;
      compiled->decide(signals, decision);
      values.push_back(decision.target[Lever::lod_scale]);
      if (rows) rows->push_back({speed, roll});
    }
  return values;
}

Policy readGood(const std::string& text, std::string notes = "") {
  const auto policy = readMatlab(text, "f.fis");
  EXPECT_TRUE(policy) << toString(policy.findings()) << text;
  EXPECT_EQ(toString(policy.findings()), notes);
  return policy ? *policy : Policy{};
}

TEST(FisFile, readsPlanesThatNoInputTiltsAsConstants) {
  EXPECT_EQ(readGood(descentWith({{"'constant',[1.25]", "'linear',[0 0 1.25]"},
                                  {"'constant',[3]", "'linear',[0, -0, 3]"},
                                  {"'constant',[7.5]", "'LINEAR',[7.5]"}})),
            readGood(kDescent));
}

TEST(FisFile, takesTheNormsThatTheRulesSay) {
  for (const char* either : {"probor", "max", "bounded_sum", ""})
    EXPECT_EQ(readGood(descentWith({{"'max'", "'" + std::string(either) + "'"}})), readGood(kDescent))
        << either;
  const auto mixed = readMatlab(descentWith({{"'max'", "'probor'"}, {"(1) : 1", "(1) : 2"}}), "f.fis");
  ASSERT_FALSE(mixed);
  EXPECT_EQ(toString(mixed.findings()).substr(0, 44), "f.fis:8: disjunction: expected Minimum with ");
  const std::string either =
      descentWith({{"'max'", "'probor'"}, {"(1) : 1", "(1) : 2"}, {"(0.75) : 1", "(0.75) : 2"}});
  EXPECT_EQ(readGood(either).norm, PolicyNorm::product) << "no rule says and";
}

TEST(FisFile, readsCapitalsCommentsMarksAndLineEndsOfAnySystem) {
  std::string capitals = descentWith({{"[System]", "[SYSTEM]"},
                                      {"Type='sugeno'", "TYPE = 'Sugeno'"},
                                      {"AndMethod='min'", "ANDMETHOD='MIN'"},
                                      {"NumMFs", "nummfs"},
                                      {"MF1='slow':'trapmf'", "mf1 = 'slow' : 'TrapMF' "},
                                      {"[Output1]", "[OUTPUT1]  % what to set"},
                                      {"[Rules]", "% the rules\n[RULES]"}});
  capitals.replace(capitals.find("  % what to set"), 15, "");
  std::string crlf = "\xef\xbb\xbf";
  for (const char c : capitals) crlf += c == '\n' ? "\r\n" : std::string(1, c);
  EXPECT_EQ(readGood(crlf), readGood(kDescent));
  const Policy commented = readGood(descentWith({{"0 2, 3 (1) : 1", "0 2, 3 (1) : 1  % banks hide detail"}}));
  EXPECT_EQ(commented.rules[2].reason, "banks hide detail");
  EXPECT_EQ(surfaceOf(commented), surfaceOf(readGood(kDescent)));
}

TEST(FisFile, makesWordsOfNamesAndSaysWhich) {
  const Policy named = readGood(descentWith({{"'slow'", "'very-slow'"},
                                             {"'fast'", "'then'"},
                                             {"'level'", "'\xc3\xa9lev\xc3\xa9'"},
                                             {"'steep'", "'3rd, [deg]: x'"},
                                             {"'fine'", "'a%1'"},
                                             {"'middle'", "'a_1'"}}),
                                "f.fis:14: name: found 'very-slow', read as very_slow\n"
                                "f.fis:15: name: found 'then', read as then_\n"
                                "f.fis:20: name: found '\xc3\xa9lev\xc3\xa9', read as _lev_\n"
                                "f.fis:21: name: found '3rd, [deg]: x', read as _3rd___deg___x\n"
                                "f.fis:26: name: found 'a%1', read as a_1_2");
  ASSERT_EQ(named.rules.size(), 3u);
  EXPECT_EQ(named.rules[0].condition, "speed is very_slow and roll is _lev_");
  EXPECT_EQ(surfaceOf(named), surfaceOf(readGood(kDescent)));
}

TEST(FisFile, ofWhichACountIsWrongIsRefusedThereOnce) {
  struct Fault {
    const char *from, *to, *finding;
  };
  for (const Fault& row :
       {Fault{"NumRules=3", "NumRules=7", "f.fis:6: NumRules: expected 3 rules, as many as follow, found 7"},
        {"NumInputs=2", "NumInputs=1", "f.fis:4: NumInputs: expected 2 inputs, as many as follow, found 1"},
        {"NumOutputs=1", "NumOutputs=0",
         "f.fis:5: NumOutputs: expected 1 outputs, as many as follow, found 0"},
        {"NumMFs=3", "NumMFs=4", "f.fis:25: NumMFs: expected 3 terms, as many as follow, found 4"},
        {"NumMFs=2", "NumMFs=many", "f.fis:13: NumMFs: expected 2 terms, as many as follow, found many"}})
    EXPECT_EQ(toString(readMatlab(descentWith({{row.from, row.to}}), "f.fis").findings()), row.finding);
}

TEST(FisFile, withOneFaultIsRefusedByOneMessage) {
  struct Fault {
    const char *from, *to, *where;
  };
  for (const Fault& row : {Fault{"'trapmf'", "'cosmf'", "f.fis:14: MF1"},
                           {"[200 420 700]", "[200 420 7o0]", "f.fis:15: MF2"},
                           {"MF1='level'", "MF2='level'", "f.fis:20: MF2"},
                           {"[200 420 700]", "[420 200 700]", "f.fis:15: terms.speed.fast"},
                           {"[Rules]", "[Ruels]", "f.fis:29: Ruels"},
                           {"[Output1]", "[Outptu1]", "f.fis:22: Outptu1"},
                           {"[System]", "[Sytsem]", "f.fis:1: Sytsem"},
                           {"[3]", "[1 3 4]", "f.fis:27: term middle"},
                           {"[7.5]", "[75]", "f.fis:28: term coarse"},
                           {"2 1, 2 (0.75) : 1\n", "2 1, 2 (0.7", "f.fis:31: Rules"}}) {
    const auto refused = readMatlab(descentWith({{row.from, row.to}}), "f.fis");
    ASSERT_FALSE(refused) << row.to;
    EXPECT_EQ(refused.findings().size(), 1u) << toString(refused.findings());
    EXPECT_EQ(refused.findings()[0].where + ": " + refused.findings()[0].key, row.where);
  }
}

TEST(FisFile, thatIsCutIsRefusedByOneMessageWhereverItIsCut) {
  for (std::size_t end = 1; end + 17 < kDescent.size(); ++end) {
    const auto refused = readMatlab(kDescent.substr(0, end), "f.fis");
    ASSERT_FALSE(refused) << end;
    EXPECT_EQ(refused.findings().size(), 1u) << toString(refused.findings());
  }
}

constexpr const char* kOtherShapes[] = {"smf',[150 480]",
                                        "zmf',[90 333]",
                                        "pimf',[60 200 260 500]",
                                        "pimf',[100 100 240 510]",
                                        "gauss2mf',[40 150 70 260]",
                                        "dsigmf',[0.06 140 0.09 390]",
                                        "psigmf',[0.05 120 -0.08 410]"};

/// The membership follows from the mean of fine, by the membership, and middle, by 1: u = (1.25 m + 3) / (m +
/// 1).
TEST(FisFile, readsMatlabsOtherShapesAsNearAsItSays) {
  if (!test::fuzzylitePresent()) GTEST_SKIP() << "needs the fuzzylite program";
  const std::string saying = "differ from it by at most ";
  for (const std::string shape : kOtherShapes) {
    const std::string text = descentWith({{"trapmf',[-10 0 120 300]", shape},
                                          {"trimf',[200 420 700]", "trapmf',[-9 -8 800 900]"},
                                          {"1 1, 1", "1 0, 1"},
                                          {"2 1, 2 (0.75)", "2 0, 2 (1)"},
                                          {"0 2, 3 (1)", "2 0, 3 (0)"}});
    const auto policy = readMatlab(text, "f.fis");
    ASSERT_TRUE(policy) << toString(policy.findings());
    ASSERT_EQ(policy.findings().size(), 1u);
    const Finding& note = policy.findings()[0];
    EXPECT_EQ(note.where, "f.fis:14");
    const double stated = std::stod(note.found.substr(note.found.find(saying) + saying.size()));
    EXPECT_LT(stated, 0.004) << shape;
    std::vector<std::vector<double>> rows;
    for (double speed = 0.25; speed < 600; speed += 0.5) rows.push_back({speed, 0});
    std::string error;
    const auto theirs = test::fisByFuzzylite(text, rows, error);
    ASSERT_EQ(error, "") << text;
    double worst = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const double expected = (3 - theirs[i][0]) / (theirs[i][0] - 1.25);
      worst = std::max(worst, std::abs(membershipOf(policy->terms[0], rows[i][0]) - expected));
    }
    EXPECT_NEAR(worst, stated, 0.05 * stated + 1e-5) << shape;
  }
}

TEST(FisFile, refusesOtherShapesWhoseNumbersHaveNoMeaning) {
  for (const std::string shape : {"smf',[480 150]", "zmf',[90]", "pimf',[60 200 190 500]", "pimf',[9 9 9 9]",
                                  "gauss2mf',[0 150 70 260]", "dsigmf',[0.06 140 0 390]", "smf',[0 inf]"}) {
    const auto refused = readMatlab(descentWith({{"trapmf',[-10 0 120 300]", shape}}), "f.fis");
    ASSERT_FALSE(refused) << shape;
    EXPECT_EQ(refused.findings().size(), 1u);
    EXPECT_EQ(refused.findings()[0].where, "f.fis:14") << toString(refused.findings());
  }
}

}  // namespace
}  // namespace trimtab
