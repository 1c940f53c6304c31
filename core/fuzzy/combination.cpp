#include "combination.h"

#include <algorithm>
#include <array>

#include "trimtab/preset/curve.h"

namespace trimtab {

double weightedOutput(std::span<const FiringRule> rules) {
  double weights = 0, outputs = 0;
  double low = 0, high = 0;
  for (const FiringRule& rule : rules) {
    const double weight = rule.weight * rule.firing;
    if (!(weight > 0)) continue;
    low = weights > 0 ? std::min(low, rule.output) : rule.output;
    high = weights > 0 ? std::max(high, rule.output) : rule.output;
    weights += weight;
    outputs += weight * rule.output;
  }
  // The quotient of two rounded sums may leave the outputs' range by an ulp, or by far where the weights are
  // denormal.
  return weights > 0 ? std::clamp(outputs / weights, low, high) : 0;
}

RuleFiring ruleFiring(const RuleList& rules, double altitude, double pitch) {
  // By condition: any, the membership, its complement.
  const double altitudes[] = {1, altitude, 1 - altitude}, pitches[] = {1, pitch, 1 - pitch};
  RuleFiring firing;
  for (const FuzzyRule& rule : rules.span())
    firing.mu[firing.count++] = std::min(altitudes[static_cast<std::size_t>(rule.altitude)],
                                         pitches[static_cast<std::size_t>(rule.pitch)]);
  return firing;
}

TotalMembership combine(Combination combination, const RuleList& rules, const RuleFiring& firing,
                        double altitude, double pitch) {
  switch (combination) {
    case Combination::sum:
      break;
    case Combination::twice_minimum:
      return {2 * std::min(altitude, pitch)};
    case Combination::rules: {
      std::array<FiringRule, RuleList::kCapacity> base;
      bool anyFires = false;
      for (std::size_t i = 0; i < rules.size; ++i) {
        base[i] = {rules.rule[i].weight, firing.mu[i], rules.rule[i].output};
        anyFires = anyFires || base[i].weight * base[i].firing > 0;
      }
      const std::span<const FiringRule> used(base.data(), rules.size);
      return {std::clamp(weightedOutput(used), 0.0, BandList::kTop), anyFires};
    }
  }
  return {altitude + pitch};
}

TotalMembership combine(Combination combination, const RuleList& rules, double altitude, double pitch) {
  return combine(combination, rules, ruleFiring(rules, altitude, pitch), altitude, pitch);
}

}  // namespace trimtab
