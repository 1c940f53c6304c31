#pragma once

#include "row.h"

namespace trimtab::bench {

/// Adds what a decision of a policy costs, beside fuzzylite on the same rules.
void policies(Report& report);

}  // namespace trimtab::bench
