#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <set>
#include <string>

#include "tests/core/fuzzy/fuzzylite_oracle.h"
#include "tests/core/policy/policy_oracle.h"
#include "tests/core/policy/random_policy.h"
#include "trimtab/policy/compiled_policy.h"
#include "trimtab/policy/policy_file.h"
#include "trimtab/preset/policy_lines.h"
#include "trimtab/preset/preset.h"

namespace trimtab {
namespace {

constexpr int kPoints = 100'000;
constexpr double kAgreement = 1e-9;

/// The shipped presets that hold a policy.
std::vector<std::string> names() {
  std::vector<std::string> with;
  for (const std::string_view name : shippedPresets())
    if (const auto preset = loadPreset(std::string(name)); preset && preset->parameters.policy.enabled)
      with.emplace_back(name);
  return with;
}

class ShippedPolicies : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    const auto preset = loadPreset(GetParam());
    ASSERT_TRUE(preset) << toString(preset.findings());
    description_ = preset->description;
    const auto policy = policyOf(preset->parameters.policy);
    ASSERT_TRUE(policy) << toString(policy.findings());
    policy_ = *policy;
    auto compiled = compile(policy_, GetParam());
    ASSERT_TRUE(compiled) << toString(compiled.findings());
    compiled_ = *std::move(compiled);
  }

  Policy policy_;
  CompiledPolicy compiled_;
  std::string description_;
};

/// The weighted mean without the firings up to 1e-6, which fuzzylite takes for 0.
double withoutTinyFirings(const Policy& policy, const PolicyDecision& decision, Lever lever) {
  double sum = 0, weight = 0;
  for (std::size_t r = 0; r < policy.rules.size(); ++r)
    for (const LeverSetting& s : policy.rules[r].settings)
      if (s.lever == lever && decision.firing[r] > 1e-6) {
        weight += decision.firing[r];
        sum += decision.firing[r] * s.value;
      }
  return sum / weight;
}

TEST_P(ShippedPolicies, agreeWithFuzzylite) {
  if (!test::fuzzylitePresent()) GTEST_SKIP() << "needs the fuzzylite program";
  const auto fll = toFuzzyLite(policy_, GetParam());
  ASSERT_TRUE(fll) << toString(fll.findings());
  std::mt19937_64 random(31);
  std::vector<SignalValues> rows;
  for (int i = 0; i < kPoints; ++i) rows.push_back(test::randomSignals(random, policy_));
  std::string error;
  const auto theirs = test::byFuzzylite(*fll, rows, error);
  ASSERT_EQ(error, "");
  ASSERT_EQ(theirs.size(), rows.size());
  double worst = 0;
  std::size_t compared = 0;
  PolicyDecision decision;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    compiled_.decide(rows[i], decision);
    for (const LeverRow& row : kLeverRows) {
      if (!compiled_.moves(row.lever)) continue;
      const double ours = withoutTinyFirings(policy_, decision, row.lever), other = theirs[i][row.lever];
      if (std::isnan(ours) && std::isnan(other)) continue;
      ASSERT_LE(std::abs(ours - other), kAgreement) << row.key << " at point " << i;
      worst = std::max(worst, std::abs(ours - other));
      ++compared;
    }
  }
  EXPECT_GT(compared, rows.size() / 2) << "most points set levers";
  std::printf("fuzzylite: %s, %d points, largest difference %.2g\n", GetParam().c_str(), kPoints, worst);
}

TEST_P(ShippedPolicies, sayWhyEachRuleIsThere) {
  EXPECT_GT(description_.size(), 200u) << "the reasoning as a whole";
  std::set<std::string> reasons;
  for (const PolicyRule& rule : policy_.rules) {
    EXPECT_GT(rule.reason.size(), 20u) << ruleText(rule);
    EXPECT_TRUE(reasons.insert(rule.reason).second) << "said twice: " << rule.reason;
    EXPECT_TRUE(rule.enabled) << ruleText(rule);
  }
}

TEST_P(ShippedPolicies, haveNoRuleThatCannotFireAndNoTermThatNobodyUses) {
  std::mt19937_64 random(32);
  std::vector<double> strongest(policy_.rules.size());
  PolicyDecision decision;
  for (int i = 0; i < kPoints; ++i) {
    compiled_.decide(test::randomSignals(random, policy_), decision);
    for (std::size_t r = 0; r < strongest.size(); ++r)
      strongest[r] = std::max(strongest[r], decision.firing[r]);
  }
  for (std::size_t r = 0; r < strongest.size(); ++r)
    EXPECT_GT(strongest[r], 0.9 * policy_.rules[r].weight) << ruleText(policy_.rules[r]);
  for (const PolicyTerm& term : policy_.terms) {
    const std::string asked = std::string(rowOf(term.signal).key) + " is ";
    EXPECT_TRUE(std::any_of(policy_.rules.begin(), policy_.rules.end(),
                            [&](const PolicyRule& rule) {
                              const std::size_t at = rule.condition.find(asked);
                              return at != std::string::npos &&
                                     rule.condition.find(term.name, at) != std::string::npos;
                            }))
        << asked << term.name;
  }
}

/// So that a lever goes back to the preset's own only where the policy says so.
TEST_P(ShippedPolicies, setEachOfTheirLeversWhereverTheirSignalsAreKnown) {
  std::mt19937_64 random(33);
  PolicyDecision decision;
  for (int i = 0; i < kPoints; ++i) {
    compiled_.decide(test::randomSignals(random, policy_), decision);
    if (decision.unknownAsked != 0) continue;
    for (const LeverRow& row : kLeverRows) {
      if (!compiled_.moves(row.lever)) continue;
      const double target = decision.target[row.lever];
      ASSERT_TRUE(target >= row.usual.low && target <= row.usual.high) << row.key << " " << target;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Presets, ShippedPolicies, testing::ValuesIn(names()), [](const auto& tested) {
  std::string name = tested.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

TEST(ShippedPolicyNames, areFour) {
  EXPECT_EQ(names(), (std::vector<std::string>{"low-level", "approach", "helmet-search", "high-cruise"}));
}

}  // namespace
}  // namespace trimtab
