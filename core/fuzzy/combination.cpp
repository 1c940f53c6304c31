#include "combination.h"

#include <algorithm>

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

std::array<double, 4> ruleFiring(double altitude, double pitch) {
  return {std::min(altitude, pitch), std::min(altitude, 1 - pitch), std::min(1 - altitude, pitch),
          std::min(1 - altitude, 1 - pitch)};
}

TotalMembership combine(Combination combination, const RuleParameters& rules, double altitude, double pitch) {
  switch (combination) {
    case Combination::sum:
      break;
    case Combination::twice_minimum:
      return {2 * std::min(altitude, pitch)};
    case Combination::rules: {
      const std::array<double, 4> mu = ruleFiring(altitude, pitch);
      const std::array<FiringRule, 4> base{
          {{rules.lowDownWeight.value(), mu[0], rules.lowDownOutput.value()},
           {rules.lowUpWeight.value(), mu[1], rules.lowUpOutput.value()},
           {rules.highDownWeight.value(), mu[2], rules.highDownOutput.value()},
           {rules.highUpWeight.value(), mu[3], rules.highUpOutput.value()}}};
      const bool anyFires =
          std::any_of(base.begin(), base.end(), [](const FiringRule& r) { return r.weight * r.firing > 0; });
      return {std::clamp(weightedOutput(base), 0.0, BandList::kTop), anyFires};
    }
  }
  return {altitude + pitch};
}

}  // namespace trimtab
