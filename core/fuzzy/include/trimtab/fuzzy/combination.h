#pragma once

#include "trimtab/preset/parameters.h"

namespace trimtab {

/// Combines the two memberships, each 0..1, to one total on the scale of the bands, 0..BandList::kTop.
double combine(Combination combination, double altitudeMembership, double pitchMembership);

}  // namespace trimtab
