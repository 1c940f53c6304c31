#include "trimtab/policy/policy_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "tests/core/fuzzy/fuzzylite_oracle.h"
#include "tests/core/policy/policy_oracle.h"
#include "tests/core/policy/random_policy.h"
#include "trimtab/policy/compiled_policy.h"

namespace trimtab {
namespace {

constexpr double kAgreement = 1e-9;

/// fuzzylite takes firings up to 1e-6 for 0. Returns what its weighted average of our firings then is; our
/// own value differs from it by no more than those firings can make.
double withoutTinyFirings(const Policy& policy, const PolicyDecision& ours, Lever lever) {
  double sum = 0, weight = 0, tiny = 0;
  for (std::size_t r = 0; r < policy.rules.size(); ++r)
    for (const LeverSetting& s : policy.rules[r].settings)
      if (s.lever == lever) {
        const double w = ours.firing[r];
        (w > 1e-6 ? weight : tiny) += w;
        if (w > 1e-6) sum += w * s.value;
      }
  const Range range = rowOf(lever).hard;
  if (weight > 0) {
    EXPECT_NEAR(ours.target[lever], sum / weight, (range.high - range.low) * tiny / weight + 1e-12);
  }
  return sum / weight;
}

/// Compares over random signals; returns the largest difference, of numbers of the size of 1.
double differenceFromFuzzylite(const Policy& policy, std::mt19937_64& random, int points) {
  const auto compiled = compile(policy, "test");
  EXPECT_TRUE(compiled) << toString(compiled.findings());
  const auto fll = toFuzzyLite(policy, "test policy");
  EXPECT_TRUE(fll) << toString(fll.findings());
  if (!compiled || !fll) return HUGE_VAL;
  std::vector<SignalValues> rows;
  for (int i = 0; i < points; ++i) rows.push_back(test::randomSignals(random, policy));
  std::string error;
  const auto theirs = test::byFuzzylite(*fll, rows, error);
  EXPECT_EQ(error, "") << *fll;
  double worst = 0;
  PolicyDecision ours;
  for (std::size_t i = 0; i < theirs.size(); ++i) {
    compiled->decide(rows[i], ours);
    for (const LeverRow& row : kLeverRows) {
      if (!compiled->moves(row.lever)) continue;
      const double a = withoutTinyFirings(policy, ours, row.lever), b = theirs[i][row.lever];
      if (std::isnan(a) && std::isnan(b)) continue;
      const double difference = std::isnan(a) || std::isnan(b) ? HUGE_VAL : std::abs(a - b);
      worst = std::max(worst, difference);
      EXPECT_LE(difference, kAgreement) << row.key << ": " << a << " against " << b << "\n" << *fll;
      if (!(difference <= kAgreement)) return worst;
    }
  }
  return worst;
}

TEST(PolicyFile, agreesWithFuzzyliteOver200RandomRuleBases) {
  if (!test::fuzzylitePresent()) GTEST_SKIP() << "needs the fuzzylite program";
  std::mt19937_64 random(11);
  double worst = 0;
  for (int i = 0; i < 200 && !HasFailure(); ++i)
    worst = std::max(worst, differenceFromFuzzylite(test::randomPolicy(random, {.signals = 1 + random() % 8,
                                                                                .terms = 8 + random() % 17,
                                                                                .rules = 1 + random() % 40,
                                                                                .levers = 1 + random() % 7}),
                                                    random, 500));
  std::printf("fuzzylite: 200 rule bases of 500 points, largest difference %.2g\n", worst);
}

TEST(PolicyFile, comesBackFromItsOwnLanguage) {
  std::mt19937_64 random(13);
  for (int i = 0; i < 100; ++i) {
    Policy policy = test::randomPolicy(random, {});
    policy.rules[0].enabled = false;
    policy.rules[1].reason = "Low and fast: the ground rushes by";
    const auto text = toFuzzyLite(policy, "p");
    ASSERT_TRUE(text) << toString(text.findings());
    const auto read = readFuzzyLite(*text, "p.fll");
    ASSERT_TRUE(read) << toString(read.findings()) << *text;
    EXPECT_EQ(read->norm, policy.norm);
    EXPECT_EQ(read->terms.size(), policy.terms.size());
    ASSERT_EQ(read->rules.size(), policy.rules.size());
    EXPECT_FALSE(read->rules[0].enabled);
    EXPECT_EQ(read->rules[1].reason, policy.rules[1].reason);
    // Terms are sorted by signal and groups are negated otherwise, so that decisions tell whether all is
    // there.
    const auto a = compile(policy, "a"), b = compile(*read, "b");
    ASSERT_TRUE(a && b);
    PolicyDecision ofA, ofB;
    for (int k = 0; k < 50; ++k) {
      const SignalValues signals = test::randomSignals(random, policy);
      a->decide(signals, ofA);
      b->decide(signals, ofB);
      for (std::size_t r = 0; r < policy.rules.size(); ++r)
        ASSERT_NEAR(ofA.firing[r], ofB.firing[r], 1e-12) << *text;
    }
    EXPECT_EQ(*toFuzzyLite(*read, "p"), *text) << "the second time to the byte";
  }
}

TEST(PolicyFile, refusesWhatAPolicyCannotSayWithItsLine) {
  const std::string good =
      "Engine: e\nInputVariable: speed\n  term: fast Ramp 100 200\nOutputVariable: lod_scale\n  default: "
      "nan\n"
      "  term: coarse Constant 4\nRuleBlock: r\n  conjunction: Minimum\n  rule: if speed is fast then "
      "lod_scale is coarse\n";
  ASSERT_TRUE(readFuzzyLite(good, "e.fll"));
  struct Bad {
    const char *from, *to, *place, *found;
  };
  for (const Bad& bad :
       {Bad{"speed\n  term", "pressure\n  term", "e.fll:2", "pressure"},
        Bad{"Ramp", "Cosine", "e.fll:3", "Cosine"}, Bad{"100 200", "100 x", "e.fll:3", "x"},
        Bad{"100 200", "100 100", "e.fll", "100 100"},
        Bad{"lod_scale\n  def", "colour\n  def", "e.fll:4", "colour"},
        Bad{"default: nan", "default: 0", "e.fll:5", "0"},
        Bad{"Constant 4", "Linear 4 5", "e.fll:6", "Linear"},
        Bad{"Minimum", "DrasticProduct", "e.fll:8", "DrasticProduct"},
        Bad{"is coarse", "is fine", "e.fll:9", "fine"}, Bad{"is fast", "is slow", "e.fll", "slow"},
        Bad{"Engine: e", "Engine e", "e.fll:1", "Engine e"}}) {
    std::string text = good;
    const std::size_t at = text.find(bad.from);
    ASSERT_NE(at, std::string::npos);
    text.replace(at, std::string(bad.from).size(), bad.to);
    const auto read = readFuzzyLite(text, "e.fll");
    ASSERT_FALSE(read) << text;
    const std::string said = toString(read.findings());
    EXPECT_NE(said.find(bad.place), std::string::npos) << said;
    EXPECT_NE(said.find(bad.found), std::string::npos) << said;
  }
  for (const char* text : {"", "RuleBlock: a\nRuleBlock: b\n", "\0\xff\x01"})
    EXPECT_FALSE(readFuzzyLite(text, "e.fll"));
}

}  // namespace
}  // namespace trimtab
