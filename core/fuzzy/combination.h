#pragma once

#include <array>
#include <span>

#include "trimtab/preset/parameters.h"

namespace trimtab {

/// One rule of Eq. (2): its weight lambda, how far its conditions hold (mu), its singleton output u.
struct FiringRule {
  double weight = 0, firing = 0, output = 0;
};

/// u = sum(lambda mu u) / sum(lambda mu) (documents A and B, Eq. 2, after Schlender and Peters); 0 where
/// nothing fires. Never outside the outputs of the rules that fire.
double weightedOutput(std::span<const FiringRule> rules);

/// mu of the shipped rules low-down, low-up, high-down, high-up: the smaller of the two conditions.
std::array<double, 4> ruleFiring(double altitudeMembership, double pitchMembership);

struct TotalMembership {
  double total = 0;      ///< 0..BandList::kTop
  bool anyFires = true;  ///< false only for a rule base of which no rule fires
};
/// The two memberships, each 0..1, as one number on the scale of the bands.
TotalMembership combine(Combination combination, const RuleParameters& rules, double altitudeMembership,
                        double pitchMembership);

}  // namespace trimtab
