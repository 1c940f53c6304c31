#pragma once

#include <algorithm>
#include <limits>

#include "trimtab/frame/terrain_index.h"

namespace trimtab {

/// Holds nothing: united with another box it is that one.
inline constexpr Box kNoBox{std::numeric_limits<float>::infinity(),  std::numeric_limits<float>::infinity(),
                            std::numeric_limits<float>::infinity(),  -std::numeric_limits<float>::infinity(),
                            -std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity()};

/// The least box that holds both; what is not a number in `b` is passed over.
inline Box united(const Box& a, const Box& b) {
  return {std::min(a.minX, b.minX), std::min(a.minY, b.minY), std::min(a.minZ, b.minZ),
          std::max(a.maxX, b.maxX), std::max(a.maxY, b.maxY), std::max(a.maxZ, b.maxZ)};
}

/// The same of a place.
inline Box united(const Box& a, float x, float y, float z) {
  return united(a, {x, y, z, x, y, z});
}

}  // namespace trimtab
