#include "trimtab/policy/policy_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

#include "tests/core/fuzzy/fuzzylite_oracle.h"
#include "tests/core/policy/policy_oracle.h"
#include "tests/core/policy/random_policy.h"
#include "tests/support.h"
#include "trimtab/policy/compiled_policy.h"

namespace trimtab {
namespace {

struct Language {
  RuleFormat format;
  const char* ending;
};
constexpr Language kLanguages[] = {{RuleFormat::fuzzylite, "fll"}, {RuleFormat::matlab, "fis"}};

Policy randomPolicyFor(RuleFormat format, std::mt19937_64& random) {
  return test::randomPolicy(random, {.signals = 1 + random() % 8,
                                     .terms = 8 + random() % 17,
                                     .rules = 2 + random() % 40,
                                     .levers = 1 + random() % 7,
                                     .numeric = format == RuleFormat::matlab});
}

/// Terms are sorted by signal, and groups are negated otherwise, so that decisions tell whether all is there.
void expectSameDecisions(const Policy& read, const Policy& policy, std::mt19937_64& random,
                         double tolerance) {
  const auto a = compile(policy, "a"), b = compile(read, "b");
  ASSERT_TRUE(a && b) << toString(b.findings());
  PolicyDecision ofA, ofB;
  for (int k = 0; k < 50; ++k) {
    const SignalValues signals = test::randomSignals(random, policy);
    a->decide(signals, ofA);
    b->decide(signals, ofB);
    for (std::size_t r = 0; r < policy.rules.size(); ++r)
      ASSERT_NEAR(ofA.firing[r], ofB.firing[r], tolerance) << policy.rules[r].condition;
    for (const LeverRow& row : kLeverRows) {
      double firing = 0;  // rounding alone may make rules fire that do not
      for (std::size_t r = 0; r < policy.rules.size(); ++r)
        for (const LeverSetting& setting : policy.rules[r].settings)
          if (setting.lever == row.lever) firing += ofA.firing[r];
      if (firing > 0.01) {
        ASSERT_NEAR(ofA.target[row.lever], ofB.target[row.lever], 1e4 * tolerance) << row.key;
      }
    }
  }
}

TEST(PolicyFile, agreesWithFuzzyliteOver200RandomRuleBasesInEachLanguage) {
  if (!test::fuzzylitePresent()) GTEST_SKIP() << "needs the fuzzylite program";
  std::mt19937_64 random(11);
  for (const Language& language : kLanguages) {
    double worst = 0;
    for (int i = 0; i < 200 && !HasFailure(); ++i)
      worst = std::max(worst, test::differenceFromFuzzylite(randomPolicyFor(language.format, random),
                                                            language.format, random, 500));
    std::printf("fuzzylite by %s: 200 rule bases of 500 points, largest difference %.2g\n", language.ending,
                worst);
  }
}

TEST(PolicyFile, comesBackFromBothLanguages) {
  std::mt19937_64 random(13);
  for (const Language& language : kLanguages)
    for (int i = 0; i < 100; ++i) {
      Policy policy = randomPolicyFor(language.format, random);
      policy.rules[0].enabled = false;
      policy.rules[0].reason = "not yet # rule: if % 'quoted' caf\xc3\xa9";
      policy.rules[1].reason = "Low and fast:\nthe ground rushes by";
      const auto text = policyFileText(policy, "p", language.format);
      ASSERT_TRUE(text) << toString(text.findings());
      const auto read = readPolicyFile(*text, "p", language.format);
      ASSERT_TRUE(read) << toString(read.findings()) << *text;
      EXPECT_EQ(read->norm, policy.norm);
      ASSERT_EQ(read->rules.size(), policy.rules.size());
      for (std::size_t r = 0; r < policy.rules.size(); ++r) {
        EXPECT_EQ(read->rules[r].enabled, policy.rules[r].enabled);
        EXPECT_EQ(read->rules[r].weight, policy.rules[r].weight);
        EXPECT_TRUE(std::is_permutation(read->rules[r].settings.begin(), read->rules[r].settings.end(),
                                        policy.rules[r].settings.begin(), policy.rules[r].settings.end()));
      }
      EXPECT_EQ(read->rules[0].reason, policy.rules[0].reason);
      EXPECT_EQ(read->rules[1].reason, "Low and fast: the ground rushes by");
      EXPECT_TRUE(std::is_permutation(read->terms.begin(), read->terms.end(), policy.terms.begin(),
                                      policy.terms.end()));
      expectSameDecisions(*read, policy, random, 1e-12);
      EXPECT_EQ(*policyFileText(*read, "p", language.format), *text) << "the second time to the byte";
    }
}

TEST(PolicyFile, isNotWrittenIfItCouldNotBeRead) {
  const auto withCondition = [](const std::string& condition) {
    Policy policy;
    policy.terms = {{Signal::altitude, "low", TermShape::ramp, {2000, 1000}}};
    policy.rules = {{condition, {{Lever::lod_scale, 2}}, 1, true, ""}};
    return policy;
  };
  // Each `or` becomes an `and` between two negated terms.
  std::string most = "low";
  for (int i = 0; i < 31; ++i) most += " or altitude is low";
  const Policy longest = withCondition("not (altitude is " + most + ")");
  ASSERT_TRUE(compile(longest, "p")) << toString(compile(longest, "p").findings());
  for (const Language& language : kLanguages) {
    EXPECT_FALSE(policyFileText(longest, "p", language.format));
    EXPECT_FALSE(policyFileText(Policy{}, "p", language.format)) << "no rules";
    EXPECT_TRUE(policyFileText(withCondition("not altitude is low"), "p", language.format));
  }
}

TEST(PolicyFile, isReadAfterFuzzyliteHasConvertedIt) {
  if (!test::fuzzylitePresent()) GTEST_SKIP() << "needs the fuzzylite program";
  std::mt19937_64 random(14);
  for (const Language& from : kLanguages)
    for (const Language& to : kLanguages)
      for (int i = 0; i < 20; ++i) {
        const bool numeric = from.format == RuleFormat::matlab || to.format == RuleFormat::matlab;
        const Policy policy = randomPolicyFor(numeric ? RuleFormat::matlab : RuleFormat::fuzzylite, random);
        const std::string text =
            test::convertedByFuzzylite(*policyFileText(policy, "p", from.format), from.ending, to.ending);
        ASSERT_NE(text, "");
        const auto read = readPolicyFile(text, "p", to.format);
        ASSERT_TRUE(read) << toString(read.findings()) << text;
        ASSERT_EQ(read->rules.size(), policy.rules.size());
        // It writes twelve decimals, and the square root of a hedge makes 1e-8 of 1e-16.
        expectSameDecisions(*read, policy, random, 1e-4);
      }
}

TEST(PolicyFile, isWrittenAsPeopleWouldWriteIt) {
  Policy policy;
  policy.terms = {{Signal::speed, "fast", TermShape::ramp, {100, 200}},
                  {Signal::speed, "middle", TermShape::gaussian, {150, 20}},
                  {Signal::roll, "steep", TermShape::bell, {60, 10, 2}},
                  {Signal::roll, "step", TermShape::points, {10, 0, 10, 1}}};
  policy.rules = {{"not (speed is very fast or roll is steep)", {{Lever::lod_scale, 4}}, 0.5, true, "why"},
                  {"roll is any", {{Lever::render_scale, 1}, {Lever::lod_scale, 2}}, 1, false, ""}};
  const auto fll = toFuzzyLite(policy, "low & fast");
  ASSERT_TRUE(fll) << toString(fll.findings());
  EXPECT_NE(fll->find("Engine: low___fast\n"), std::string::npos);
  EXPECT_NE(fll->find("  term: step Discrete 9.999999999999991 0 10 1\n"), std::string::npos) << *fll;
  EXPECT_NE(
      fll->find("  rule: if speed is not very fast and roll is not steep then lod_scale is v2 with 0.5"
                "  # why\n  # rule: if roll is any then render_scale is v1 and lod_scale is v1 with 1\n"),
      std::string::npos)
      << *fll;
  const auto fis = toMatlab(policy, "low & fast");
  ASSERT_TRUE(fis) << toString(fis.findings());
  EXPECT_NE(fis->find("MF2='middle':'gaussmf',[20 150]\n"), std::string::npos) << *fis;
  EXPECT_NE(fis->find("MF1='steep':'gbellmf',[10 2 60]\n"), std::string::npos) << *fis;
  EXPECT_NE(fis->find("[Rules]\n% reason: why\n-1 -1.2, 2 0 (0.5) : 1\n% rule: 0.99 0, 1 1 (1) : 1\n"),
            std::string::npos)
      << *fis;
}

TEST(PolicyFile, refusesTheRulesThatNumbersCannotSayOneByOne) {
  Policy policy;
  policy.terms = {{Signal::speed, "fast", TermShape::ramp, {100, 200}},
                  {Signal::speed, "slow", TermShape::ramp, {200, 100}},
                  {Signal::roll, "steep", TermShape::ramp, {20, 60}},
                  {Signal::pitch, "up", TermShape::ramp, {0, 20}}};
  const auto rule = [&policy](const char* condition) {
    policy.rules.push_back({condition, {{Lever::lod_scale, 4}}, 1, true, ""});
  };
  rule("speed is fast and roll is steep or pitch is up");
  rule("speed is fast and (roll is steep or pitch is up)");
  rule("speed is fast or speed is slow");
  rule("speed is very somewhat fast");
  rule("speed is very not fast");
  rule("speed is very any");
  rule("speed is fast and not (roll is steep and pitch is up)");
  rule("speed is fast and not (roll is steep or pitch is up)");  // De Morgan makes one connective of it
  const auto text = toMatlab(policy, "p");
  ASSERT_FALSE(text);
  EXPECT_EQ(
      toString(text.findings()),
      "p: rules.1: expected \"and\" alone, or \"or\" alone, found a group in parentheses\n"
      "p: rules.2: expected \"and\" alone, or \"or\" alone, found a group in parentheses\n"
      "p: rules.3: expected each input once, found speed twice\n"
      "p: rules.4: expected no hedges, or not, or one of very, somewhat, extremely and seldom, with not "
      "before it, found very somewhat fast\n"
      "p: rules.5: expected no hedges, or not, or one of very, somewhat, extremely and seldom, with not "
      "before it, found very not fast\n"
      "p: rules.6: expected no hedges, or not, or one of very, somewhat, extremely and seldom, with not "
      "before it, found very any\n"
      "p: rules.7: expected \"and\" alone, or \"or\" alone, found a group in parentheses");
  EXPECT_TRUE(toFuzzyLite(policy, "p")) << "which has words for all of them";
}

TEST(PolicyFile, isKnownByItsEnding) {
  EXPECT_EQ(ruleFormatOf("a/b.fll"), RuleFormat::fuzzylite);
  EXPECT_EQ(ruleFormatOf("b.fis"), RuleFormat::matlab);
  EXPECT_FALSE(ruleFormatOf("b.json"));
}

TEST(PolicyFile, ofTheFormerRuleBaseSetsTheOcclusion) {
  for (const Language& language : kLanguages) {
    const std::string file = "rules/default." + std::string(language.ending);
    const auto policy =
        readPolicyFile(test::readFile(test::sourceDir() / "tests/data" / file), file, language.format);
    ASSERT_TRUE(policy) << toString(policy.findings());
    ASSERT_EQ(policy->rules.size(), 4u);
    EXPECT_EQ(policy->rules[0].settings, (std::vector<LeverSetting>{{Lever::occlusion, 2}}));
    SignalValues signals;
    signals[Signal::altitude] = 5500, signals[Signal::pitch] = -3;
    PolicyDecision decision;
    compile(*policy, "p")->decide(signals, decision);
    // By hand: low 0.45, down 0.55, so mu 0.45, 0.45, 0.55, 0.45.
    EXPECT_NEAR(decision.target[Lever::occlusion], (0.45 * 2 + 0.45 * 1 + 0.55 * 0.5) / (3 * 0.45 + 0.55),
                1e-12);
  }
}

}  // namespace
}  // namespace trimtab
