#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "trimtab/frame/terrain_index.h"

namespace trimtab {

/// One light: a point that looks as large from near as from far.
struct LightPoint {
  float x = 0, y = 0, z = 0;  ///< metres from its cell's origin, along the local frame
  std::array<std::uint8_t, 4> colour{255, 255, 255, 255};  ///< sRGB; the last is not used
};
static_assert(sizeof(LightPoint) == 16);

/// The lights of a terrain in cells, as flat arrays. There is no tree over the cells: one of 256 lights costs
/// a box test, so a million lights cost 4,000 of them.
struct LightIndex {
  static constexpr std::uint32_t kMostInCell = 256;
  struct Cell {
    Box bounds;                            ///< of its lights, metres in the local frame
    std::array<std::int32_t, 3> origin{};  ///< multiples of 16 m in the local frame
    std::uint32_t first = 0, count = 0;    ///< its run of `points`
  };
  std::vector<Cell> cells;  ///< share out `points` in order
  std::vector<LightPoint> points;
};

}  // namespace trimtab
