#pragma once

#include <string>
#include <vector>

#include "migration.h"

namespace trimtab {

/// Replaces the rule base that versions up to 3 had beside the policy (`fuzzy.rules`, used where
/// `fuzzy.combination` was `rules`) by rules of the policy that set the lever *occlusion* from the same two
/// memberships. Where some rule fires, a decision is the same to the bit if the greatest weight is a power of
/// two; else weights are rounded once. Where none fires the former total was 0; now it is the sum, and a note
/// says so if that can happen. `base` holds what the file leaves out.
void replaceFormerRules(const TuningParameters& base, std::vector<RawParameter>& parameters,
                        FindingList& notes);

}  // namespace trimtab
