#pragma once

#include <string>

#include "trimtab/harness/results.h"

namespace trimtab::harness {

/// For a terminal: a line a unit, then the ratios with their intervals, then what skips saved.
std::string toText(const Results& results);

}  // namespace trimtab::harness
