#include "trimtab/policy/policy_review.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>

#include "tests/core/policy/random_policy.h"
#include "trimtab/policy/compiled_policy.h"
#include "trimtab/policy/condition_terms.h"

namespace trimtab {
namespace {

PolicyTerm reviewTerm(Signal signal, const char* name, const char* shape) {
  auto read = readShape(shape, "test");
  EXPECT_TRUE(read) << toString(read.findings());
  PolicyTerm made = read ? *read : PolicyTerm{};
  made.signal = signal;
  made.name = name;
  return made;
}

Policy policyOf(std::vector<PolicyTerm> terms, std::initializer_list<const char*> rules) {
  Policy policy;
  policy.terms = std::move(terms);
  for (const char* text : rules) {
    const auto read = readPolicyRule(text, "test");
    EXPECT_TRUE(read) << toString(read.findings());
    if (read) policy.rules.push_back(*read);
  }
  return policy;
}

std::vector<PolicyTerm> lowAndHigh() {
  return {reviewTerm(Signal::above_ground, "low", "ramp 2000 1000"),
          reviewTerm(Signal::above_ground, "high", "ramp 1000 2000")};
}

/// The findings of one key, as text.
std::string of(const Findings& findings, const std::string& key) {
  std::string text;
  for (const Finding& finding : findings)
    if (finding.key == key) text += toString(finding) + "\n";
  return text;
}

TEST(ReviewPolicy, findsNothingButRestingLeversInASoundPolicy) {
  const Policy policy = policyOf(lowAndHigh(), {"if above_ground is low then lod_scale = 1",
                                                "if above_ground is high then lod_scale = 1.5"});
  const Findings findings = reviewPolicy(policy);
  ASSERT_EQ(findings.size(), 1u) << toString(findings);
  EXPECT_EQ(findings[0].key, "levers");
  EXPECT_EQ(findings[0].severity, Severity::note);
  EXPECT_EQ(findings[0].found.find("lod_scale"), std::string::npos);
  EXPECT_NE(findings[0].found.find("render_scale"), std::string::npos);
  EXPECT_TRUE(reviewPolicy({}).empty());
}

TEST(ReviewPolicy, givesTheCompilersFindingsForAPolicyThatDoesNotCompile) {
  const Policy policy = policyOf(lowAndHigh(), {"if above_ground is deep then lod_scale = 1"});
  EXPECT_EQ(reviewPolicy(policy), compile(policy, "").findings());
}

TEST(ReviewPolicy, findsATermThatNobodyUses) {
  Policy policy = policyOf(lowAndHigh(), {"if above_ground is low then lod_scale = 1",
                                          "if not above_ground is low then lod_scale = 2"});
  EXPECT_NE(of(reviewPolicy(policy), "terms.above_ground.high").find("found none"), std::string::npos);
  EXPECT_EQ(of(reviewPolicy(policy), "terms.above_ground.low"), "");
  policy.rules.push_back(*readPolicyRule("if above_ground is high then lod_scale = 2", ""));
  EXPECT_EQ(of(reviewPolicy(policy), "terms.above_ground.high"), "");
  policy.rules.back().enabled = false;
  EXPECT_NE(of(reviewPolicy(policy), "terms.above_ground.high").find("switched off"), std::string::npos);
}

TEST(ReviewPolicy, findsARuleOfWeightZeroUnlessItIsSwitchedOff) {
  Policy policy = policyOf(lowAndHigh(), {"if above_ground is low then lod_scale = 1",
                                          "if above_ground is high then lod_scale = 1.5"});
  EXPECT_EQ(of(reviewPolicy(policy), "rules.2"), "");
  policy.rules[1].weight = 0;
  EXPECT_NE(of(reviewPolicy(policy), "rules.2").find("weight 0"), std::string::npos);
  policy.rules[1].enabled = false;
  EXPECT_EQ(of(reviewPolicy(policy), "rules.2"), "");
}

TEST(ReviewPolicy, findsARuleThatCanNeverFire) {
  struct Case {
    const char* condition;
    bool never;
  };
  std::vector<PolicyTerm> terms = lowAndHigh();
  terms.push_back(reviewTerm(Signal::above_ground, "deep", "trapezoid -5000 -4000 -3000 -2000"));
  terms.push_back(reviewTerm(Signal::above_ground, "at_hover", "gaussian 90 1"));
  terms.push_back(reviewTerm(Signal::speed, "beyond", "gaussian 9000 100"));
  terms.push_back(reviewTerm(Signal::speed, "fast", "sigmoid 300 0.1"));
  terms.push_back(reviewTerm(Signal::above_ground, "sea", "ramp 30 20"));
  for (const Case& c : {Case{"above_ground is low", false},
                        {"above_ground is low and above_ground is high", false},
                        {"above_ground is deep", true},
                        {"speed is fast and above_ground is deep", true},
                        {"speed is fast or above_ground is deep", false},
                        {"speed is beyond", true},
                        {"not speed is beyond", false},
                        {"above_ground is at_hover", false},
                        {"above_ground is at_hover and speed is fast", false},
                        {"above_ground is at_hover and above_ground is high", true},
                        {"above_ground is sea and above_ground is high", true},
                        {"above_ground is not any", true}}) {
    Policy policy = policyOf(terms, {"if speed is any then lod_scale = 1"});
    policy.rules.push_back({c.condition, {{Lever::lod_scale, 1}}, 1, true, ""});
    const std::string found = of(reviewPolicy(policy), "rules.2");
    EXPECT_EQ(found.find("fires at most") != std::string::npos, c.never) << c.condition << ": " << found;
    policy.rules.back().enabled = false;
    EXPECT_EQ(of(reviewPolicy(policy), "rules.2"), "") << "switched off";
  }
}

TEST(ReviewPolicy, namesTheRegionThatNoRuleCovers) {
  std::vector<PolicyTerm> terms = lowAndHigh();
  terms.push_back(reviewTerm(Signal::speed, "slow", "ramp 200 100"));
  terms.push_back(reviewTerm(Signal::speed, "fast", "ramp 100 200"));
  Policy policy = policyOf(terms, {"if above_ground is low then lod_scale = 1",
                                   "if above_ground is high and speed is slow then lod_scale = 1.5"});
  const std::string found = of(reviewPolicy(policy), "rules");
  EXPECT_NE(found.find("above_ground from 2000 to 60000 ft"), std::string::npos) << found;
  EXPECT_NE(found.find("speed from 200 to 1500 kt"), std::string::npos) << found;
  policy.rules.push_back(
      *readPolicyRule("if above_ground is high and speed is fast then lod_scale = 1.5", ""));
  EXPECT_EQ(of(reviewPolicy(policy), "rules"), "");
}

TEST(ReviewPolicy, findsTwoRulesThatFight) {
  std::vector<PolicyTerm> terms = lowAndHigh();
  terms.push_back(reviewTerm(Signal::speed, "fast", "ramp 200 400"));
  const Policy fight = policyOf(terms, {"if above_ground is low then screen_space_error = 1",
                                        "if speed is fast then screen_space_error = 16"});
  const std::string found = of(reviewPolicy(fight), "rules.1");
  EXPECT_NE(found.find("1 px against 16 px of rule 2"), std::string::npos) << found;
  EXPECT_NE(found.find("above_ground"), std::string::npos) << found;
  const Policy close = policyOf(terms, {"if above_ground is low then screen_space_error = 4",
                                        "if speed is fast then screen_space_error = 6"});
  EXPECT_EQ(of(reviewPolicy(close), "rules.1"), "") << "values that are near";
  const Policy apart = policyOf(terms, {"if above_ground is low then screen_space_error = 1",
                                        "if above_ground is high then screen_space_error = 16"});
  EXPECT_EQ(of(reviewPolicy(apart), "rules.1"), "") << "they share only the middle, where both fire by half";
  const Policy other = policyOf(
      terms, {"if above_ground is low then screen_space_error = 1", "if speed is fast then lod_scale = 4"});
  EXPECT_EQ(of(reviewPolicy(other), "rules.1"), "") << "different levers";
}

TEST(ReviewPolicy, isTheSameEveryTimeAndTakesMillisecondsForFortyRules) {
  std::mt19937_64 random(5);
  double worstMs = 0;
  for (int i = 0; i < 20; ++i) {
    const Policy policy = test::randomPolicy(random, {8, 24, 40, 6});
    const auto start = std::chrono::steady_clock::now();
    const Findings findings = reviewPolicy(policy);
    worstMs = std::max(
        worstMs, std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
    EXPECT_EQ(findings, reviewPolicy(policy));
  }
  RecordProperty("worst_ms", std::to_string(worstMs));
  std::printf("the slowest review took %.2f ms\n", worstMs);
}

TEST(ReviewPolicy, takesTheLargestPolicies) {
  std::mt19937_64 random(6);
  const Policy policy = test::randomPolicy(random, {12, kMostPolicyTerms, kMostPolicyRules, 7});
  EXPECT_LT(reviewPolicy(policy).size(), kMostPolicyTerms + kMostPolicyRules + 20);
}

TEST(ConditionTerms, areFoundAndRenamedInPlace) {
  const std::string condition = "above_ground is very low and not  ( speed is low or above_ground is low )";
  const auto uses = termsIn(condition);
  ASSERT_EQ(uses.size(), 3u);
  EXPECT_EQ(uses[1].signal, Signal::speed);
  EXPECT_EQ(withTermRenamed(condition, Signal::above_ground, "low", "near"),
            "above_ground is very near and not  ( speed is low or above_ground is near )");
  EXPECT_EQ(withTermRenamed(condition, Signal::above_ground, "lo", "near"), condition);
  EXPECT_EQ(withTermRenamed("above_ground is", Signal::above_ground, "low", "near"), "above_ground is");
  EXPECT_TRUE(termsIn("above_ground is any").empty());
}

}  // namespace
}  // namespace trimtab
