#pragma once

#include <string>

#include "trimtab/policy/fuzzy_system.h"

namespace trimtab::fuzzy_system {

/// Returns the system with the shapes of a policy for its inputs and with constants for its outputs, and
/// notes that say what was changed and how far the new system is from the old one.
///
/// Each rule of an output with planes, or of Mamdani's kind, gets a constant of its own; together they bring
/// the output's surface as near to the file's as they can, and the difference is taken on a grid. Above 5 %
/// of the output's range, or of what its surface spans if that is more, the rules are replaced by a table
/// that stays below, with a warning. `acceptDifference` keeps them. Without it, what no table comes near is
/// refused.
Result<System> orderZeroOf(System system, const std::string& where, bool acceptDifference);

}  // namespace trimtab::fuzzy_system
