#include "trimtab/fuzzy/combination.h"

#include <algorithm>

namespace trimtab {

double combine(Combination combination, double altitudeMembership, double pitchMembership) {
  if (combination == Combination::twice_minimum) return 2 * std::min(altitudeMembership, pitchMembership);
  return altitudeMembership + pitchMembership;
}

}  // namespace trimtab
