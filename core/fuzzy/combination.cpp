#include "trimtab/fuzzy/combination.h"

#include <algorithm>

#include "trimtab/preset/curve.h"

namespace trimtab {

void fireRules(const RuleList& rules, double altitude, double pitch, RuleFiring& firing) {
  // By condition: any, the membership, its complement.
  const double altitudes[] = {1, altitude, 1 - altitude}, pitches[] = {1, pitch, 1 - pitch};
  for (std::size_t i = 0; i < rules.size; ++i)
    firing.mu[i] = std::min(altitudes[static_cast<std::size_t>(rules.rule[i].altitude)],
                            pitches[static_cast<std::size_t>(rules.rule[i].pitch)]);
  firing.count = rules.size;
}

RuleFiring ruleFiring(const RuleList& rules, double altitude, double pitch) {
  RuleFiring firing;
  fireRules(rules, altitude, pitch, firing);
  return firing;
}

TotalMembership weightedOutput(const RuleList& rules, const RuleFiring& firing) {
  double weights = 0, outputs = 0;
  double low = BandList::kTop, high = 0;
  for (std::size_t i = 0; i < rules.size; ++i) {
    const double weight = rules.rule[i].weight * firing.mu[i], output = rules.rule[i].output;
    if (!(weight > 0)) continue;
    low = std::min(low, output);
    high = std::max(high, output);
    weights += weight;
    outputs += weight * output;
  }
  if (!(weights > 0)) return {0, false};
  // The quotient of two rounded sums may leave the outputs' range by an ulp, or by far where the weights are
  // denormal.
  return {std::clamp(outputs / weights, low, high), true};
}

TotalMembership combine(Combination combination, const RuleList& rules, const RuleFiring& firing,
                        double altitude, double pitch) {
  switch (combination) {
    case Combination::sum:
      break;
    case Combination::twice_minimum:
      return {2 * std::min(altitude, pitch)};
    case Combination::rules:
      return weightedOutput(rules, firing);
  }
  return {altitude + pitch};
}

TotalMembership combine(Combination combination, const RuleList& rules, double altitude, double pitch) {
  return combine(combination, rules, ruleFiring(rules, altitude, pitch), altitude, pitch);
}

}  // namespace trimtab
