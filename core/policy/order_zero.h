#pragma once

#include <string>

#include "trimtab/policy/fuzzy_system.h"

namespace trimtab::fuzzy_system {

/// Returns the system with the shapes of a policy for its inputs and with constants for its outputs, and
/// notes that say what was changed and how far the new system is from the old one.
///
/// A plane over the inputs becomes, for each rule, the constant that is nearest to it by least squares
/// weighted with how far the rule fires; a term of an output of Mamdani's kind becomes its centroid. The
/// difference of both surfaces is taken on a grid. Above 5 % of the output's range, or of what its surface
/// spans if that is more, the system is refused unless `acceptDifference`.
Result<System> orderZeroOf(System system, const std::string& where, bool acceptDifference);

}  // namespace trimtab::fuzzy_system
