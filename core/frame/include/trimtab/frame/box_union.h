#pragma once

#include <algorithm>
#include <limits>

#include "trimtab/frame/terrain_index.h"

namespace trimtab {

/// The empty box: united with another box it gives that box.
inline constexpr Box kNoBox{std::numeric_limits<float>::infinity(),  std::numeric_limits<float>::infinity(),
                            std::numeric_limits<float>::infinity(),  -std::numeric_limits<float>::infinity(),
                            -std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity()};

/// Returns the smallest box that holds both. Bounds of `b` that are not numbers are ignored.
inline Box united(const Box& a, const Box& b) {
  return {std::min(a.minX, b.minX), std::min(a.minY, b.minY), std::min(a.minZ, b.minZ),
          std::max(a.maxX, b.maxX), std::max(a.maxY, b.maxY), std::max(a.maxZ, b.maxZ)};
}

/// Returns the smallest box that holds the box and a place.
inline Box united(const Box& a, float x, float y, float z) {
  return united(a, {x, y, z, x, y, z});
}

}  // namespace trimtab
