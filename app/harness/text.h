#pragma once

#include <string>

#include "results.h"

namespace trimtab::harness {

/// For a terminal: a line a unit, the ratios with their intervals, a line a skip.
std::string toText(const Results& results);

}  // namespace trimtab::harness
