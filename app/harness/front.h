#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "results.h"

namespace trimtab::harness {

/// The units of one flight that no other surely beats in frame time or in an error without losing in the
/// other.
struct Front {
  std::string flight;
  const Quantity* error = nullptr;
  bool known = false;              ///< whether the frames are enough to say
  std::vector<std::size_t> units;  ///< indices into Results::units, by ascending error
};

/// Returns the front of each flight for each error that was measured, FLIP first.
std::vector<Front> frontsOf(const Results& results);

}  // namespace trimtab::harness
