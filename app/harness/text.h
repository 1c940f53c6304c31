#pragma once

#include <string>

#include "results.h"

namespace trimtab::harness {

/// Returns text for a terminal: one line per unit, the ratios with their intervals, one line per skip.
std::string toText(const Results& results);

}  // namespace trimtab::harness
