#pragma once

#include <string>

#include "trimtab/policy/fuzzy_system.h"

namespace trimtab::fuzzy_system {

/// Returns the system with the shapes of a policy for its inputs and with constants for its outputs, and
/// notes that say what was changed and how far the new system is from the old one at most.
Result<System> orderZeroOf(System system, const std::string& where);

}  // namespace trimtab::fuzzy_system
