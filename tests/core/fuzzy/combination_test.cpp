#include "trimtab/fuzzy/combination.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

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
  RuleList rules = kRuleBase;
  rules.rule[1].weight = 0.7;
  // By hand, altitude 0.7998, pitch 0.445: mu 0.445, 0.555, 0.2002, 0.2002; outputs 2, 1, 0.5, 0.
  const double above = 0.445 * 2 + 0.7 * 0.555 * 1 + 0.2002 * 0.5,
               below = 0.445 + 0.7 * 0.555 + 0.2002 + 0.2002;
  EXPECT_NEAR(combine(Combination::rules, rules, 0.7998, 0.445).total, above / below, 1e-15);
}

TEST(Combination, rulesYieldTheOutputOfTheOnlyOneThatFires) {
  const double altitudes[] = {1, 1, 0, 0}, pitches[] = {1, 0, 1, 0};
  for (std::size_t i = 0; i < kRuleBase.size; ++i)
    EXPECT_EQ(combine(Combination::rules, kRuleBase, altitudes[i], pitches[i]).total,
              kRuleBase.rule[i].output);
}

TEST(Combination, aRuleBaseThatDoesNotFireYieldsZeroAndSaysSo) {
  RuleList rules = kRuleBase;
  rules.rule[0].weight = 0;
  const TotalMembership total = combine(Combination::rules, rules, 1, 1);
  EXPECT_EQ(total.total, 0);
  EXPECT_FALSE(total.anyFires);
  EXPECT_TRUE(combine(Combination::rules, rules, 0.9, 1).anyFires);
  EXPECT_TRUE(combine(Combination::sum, rules, 1, 1).anyFires);
}

TEST(WeightedOutput, staysAmongTheOutputsWhateverTheWeights) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(0, 1), exponent(-1074, 10);
  for (int round = 0; round < 100000; ++round) {
    RuleList rules;
    RuleFiring firing;
    double low = 2, high = 0;
    for (int i = 0; i < 4; ++i) {
      const FuzzyRule rule{AltitudeCondition::any, PitchCondition::any, std::exp2(exponent(random)),
                           2 * unit(random)};
      rules.rule[rules.size++] = rule;
      firing.mu[firing.count++] = unit(random);
      if (rule.weight * firing.mu[firing.count - 1] <= 0) continue;
      low = std::min(low, rule.output);
      high = std::max(high, rule.output);
    }
    const TotalMembership u = weightedOutput(rules, firing);
    ASSERT_EQ(u.anyFires, high >= low);
    if (!u.anyFires)
      ASSERT_EQ(u.total, 0);
    else
      ASSERT_TRUE(u.total >= low && u.total <= high) << u.total;
  }
}

TEST(WeightedOutput, ignoresARuleWhoseWeightIsNotANumber) {
  const RuleList rules{
      {AltitudeCondition::any, PitchCondition::any, std::numeric_limits<double>::quiet_NaN(), 2},
      {AltitudeCondition::any, PitchCondition::any, 1, 0.5}};
  EXPECT_EQ(weightedOutput(rules, ruleFiring(rules, 1, 1)).total, 0.5);
}

TEST(Combination, anEmptyRuleBaseYieldsZeroAndSaysSo) {
  const TotalMembership total = combine(Combination::rules, RuleList{}, 1, 1);
  EXPECT_EQ(total.total, 0);
  EXPECT_FALSE(total.anyFires);
}

TEST(Combination, sixteenRulesMayShareTheirConditions) {
  RuleList rules;
  for (std::size_t i = 0; i < RuleList::kCapacity; ++i)
    rules.rule[rules.size++] = {AltitudeCondition::low, PitchCondition::any, 1.0 + static_cast<double>(i),
                                0.125 * static_cast<double>(i)};
  // By hand: sum of (1 + i) i / 8 over sum of 1 + i is (1360 / 8) / 136.
  EXPECT_NEAR(combine(Combination::rules, rules, 0.3, 0.9).total, 1.25, 1e-15);
}

std::vector<double> firing(const RuleList& rules, double altitude, double pitch) {
  const RuleFiring fired = ruleFiring(rules, altitude, pitch);
  return {fired.span().begin(), fired.span().end()};
}

TEST(RuleFiring, isTheSmallerOfTwoConditions) {
  EXPECT_EQ(firing(kRuleBase, 0.75, 0.5), (std::vector<double>{0.5, 0.5, 0.25, 0.25}));
  EXPECT_EQ(firing(kRuleBase, 1, 0), (std::vector<double>{0, 1, 0, 0}));
}

TEST(RuleFiring, leavesOutAConditionThatIsAny) {
  const RuleList rules{{AltitudeCondition::low, PitchCondition::any, 1, 0},
                       {AltitudeCondition::high, PitchCondition::any, 1, 0},
                       {AltitudeCondition::any, PitchCondition::nose_down, 1, 0},
                       {AltitudeCondition::any, PitchCondition::nose_up, 1, 0},
                       {AltitudeCondition::any, PitchCondition::any, 1, 0}};
  EXPECT_EQ(firing(rules, 0.75, 0.125), (std::vector<double>{0.75, 0.25, 0.125, 0.875, 1}));
  EXPECT_TRUE(firing(RuleList{}, 1, 1).empty());
}

}  // namespace
}  // namespace trimtab
