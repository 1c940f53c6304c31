#include "trimtab/fuzzy/combination.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace trimtab {
namespace {

TEST(Combination, sumAddsTheMemberships) {
  EXPECT_EQ(combine(Combination::sum, {}, 0.6, 0.5).total, 1.1);
  EXPECT_EQ(combine(Combination::sum, {}, 1, 1).total, 2);
}

TEST(Combination, twiceTheMinimumNeedsBoth) {
  EXPECT_EQ(combine(Combination::twice_minimum, {}, 0, 1).total, 0);
  EXPECT_EQ(combine(Combination::twice_minimum, {}, 0.6, 0.5).total, 1);
}

TEST(Combination, rulesWeighTheOutputsByWhatFires) {
  RuleParameters rules;
  rules.lowUpWeight = Ratio{0.7};
  // By hand, altitude 0.7998, pitch 0.445: mu 0.445, 0.555, 0.2002, 0.2002; outputs 2, 1, 0.5, 0.
  const double above = 0.445 * 2 + 0.7 * 0.555 * 1 + 0.2002 * 0.5,
               below = 0.445 + 0.7 * 0.555 + 0.2002 + 0.2002;
  EXPECT_NEAR(combine(Combination::rules, rules, 0.7998, 0.445).total, above / below, 1e-15);
}

TEST(Combination, rulesYieldTheOutputOfTheOnlyOneThatFires) {
  const RuleParameters rules;
  EXPECT_EQ(combine(Combination::rules, rules, 1, 1).total, rules.lowDownOutput.value());
  EXPECT_EQ(combine(Combination::rules, rules, 1, 0).total, rules.lowUpOutput.value());
  EXPECT_EQ(combine(Combination::rules, rules, 0, 1).total, rules.highDownOutput.value());
  EXPECT_EQ(combine(Combination::rules, rules, 0, 0).total, rules.highUpOutput.value());
}

TEST(Combination, aRuleBaseThatDoesNotFireYieldsZeroAndSaysSo) {
  RuleParameters rules;
  rules.lowDownWeight = Ratio{0};
  const TotalMembership total = combine(Combination::rules, rules, 1, 1);
  EXPECT_EQ(total.total, 0);
  EXPECT_FALSE(total.anyFires);
  EXPECT_TRUE(combine(Combination::rules, rules, 0.9, 1).anyFires);
  EXPECT_TRUE(combine(Combination::sum, rules, 1, 1).anyFires);
}

TEST(WeightedOutput, isZeroForNoRules) {
  EXPECT_EQ(weightedOutput({}), 0);
}

TEST(WeightedOutput, staysAmongTheOutputsWhateverTheWeights) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(0, 1), exponent(-1074, 10);
  for (int round = 0; round < 100000; ++round) {
    std::array<FiringRule, 4> rules;
    for (FiringRule& rule : rules) rule = {std::exp2(exponent(random)), unit(random), 2 * unit(random)};
    double low = 2, high = 0;
    for (const FiringRule& rule : rules) {
      if (rule.weight * rule.firing <= 0) continue;
      low = std::min(low, rule.output);
      high = std::max(high, rule.output);
    }
    const double u = weightedOutput(rules);
    if (high < low)
      ASSERT_EQ(u, 0);
    else
      ASSERT_TRUE(u >= low && u <= high) << u;
  }
}

TEST(WeightedOutput, ignoresARuleWhoseWeightIsNotANumber) {
  const std::array<FiringRule, 2> rules{{{std::numeric_limits<double>::quiet_NaN(), 1, 2}, {1, 1, 0.5}}};
  EXPECT_EQ(weightedOutput(rules), 0.5);
}

TEST(RuleFiring, isTheSmallerOfTwoConditions) {
  EXPECT_EQ(ruleFiring(0.75, 0.5), (std::array<double, 4>{0.5, 0.5, 0.25, 0.25}));
  EXPECT_EQ(ruleFiring(1, 0), (std::array<double, 4>{0, 1, 0, 0}));
}

}  // namespace
}  // namespace trimtab
