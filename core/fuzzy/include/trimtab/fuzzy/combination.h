#pragma once

#include "trimtab/frame/rule_firing.h"
#include "trimtab/preset/parameters.h"

namespace trimtab {

/// mu of each rule: the smallest of its conditions' memberships; 1 for a rule without conditions.
void fireRules(const RuleList& rules, double altitudeMembership, double pitchMembership, RuleFiring& firing);
RuleFiring ruleFiring(const RuleList& rules, double altitudeMembership, double pitchMembership);

struct TotalMembership {
  double total = 0;      ///< 0..BandList::kTop
  bool anyFires = true;  ///< false only for a rule base of which no rule fires
};

/// u = sum(lambda mu u) / sum(lambda mu) (documents A and B, Eq. 2, after Schlender and Peters); 0 where
/// nothing fires. Never outside the outputs of the rules that fire.
TotalMembership weightedOutput(const RuleList& rules, const RuleFiring& firing);

/// The two memberships, each 0..1, as one number on the scale of the bands.
TotalMembership combine(Combination combination, const RuleList& rules, double altitudeMembership,
                        double pitchMembership);
/// The same, with what ruleFiring() gave for the same memberships.
TotalMembership combine(Combination combination, const RuleList& rules, const RuleFiring& firing,
                        double altitudeMembership, double pitchMembership);

}  // namespace trimtab
