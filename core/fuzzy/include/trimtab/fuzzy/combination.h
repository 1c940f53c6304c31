#pragma once

#include "trimtab/frame/rule_firing.h"
#include "trimtab/preset/parameters.h"

namespace trimtab {

/// Computes mu of each rule: the smallest of its conditions' memberships, 1 for a rule without conditions.
void fireRules(const RuleList& rules, double altitudeMembership, double pitchMembership, RuleFiring& firing);
RuleFiring ruleFiring(const RuleList& rules, double altitudeMembership, double pitchMembership);

struct TotalMembership {
  double total = 0;      ///< 0..BandList::kTop
  bool anyFires = true;  ///< false only if the rule base is used and no rule fires
};

/// Returns u = sum(lambda mu u) / sum(lambda mu) (documents A and B, Eq. 2, after Schlender and Peters), and
/// 0 if no rule fires. It is never outside the outputs of the rules that fire.
TotalMembership weightedOutput(const RuleList& rules, const RuleFiring& firing);

/// Combines the two memberships, each 0..1, to one total on the scale of the bands.
TotalMembership combine(Combination combination, const RuleList& rules, double altitudeMembership,
                        double pitchMembership);
/// Does the same with the result of ruleFiring() for the same memberships.
TotalMembership combine(Combination combination, const RuleList& rules, const RuleFiring& firing,
                        double altitudeMembership, double pitchMembership);

}  // namespace trimtab
