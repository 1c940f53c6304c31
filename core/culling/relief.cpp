#include "trimtab/culling/relief.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace trimtab {

void TileRelief::finish(int step) {
  const auto at = [this](int column, int row) {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(side) + static_cast<std::size_t>(column);
  };
  lines = 0;
  lineX.clear();
  lineY.clear();
  lineZ.clear();
  parts.clear();
  peaks.clear();
  bounds = {};
  reach = 0;
  for (const auto* values : {&x, &y, &z})
    for (const float value : *values) {
      if (!std::isfinite(value)) return;
      reach = std::max(reach, std::abs(value));
    }
  const auto add = [&](std::size_t post) {
    lineX.push_back(x[post]);
    lineY.push_back(y[post]);
    lineZ.push_back(z[post]);
  };
  // Not the borders: beside a coarser neighbour their odd posts are not drawn.
  for (int across = step; across < side - 1; across += step) {
    for (int along = 0; along < side; ++along) add(at(along, across));
    for (int along = 0; along < side; ++along) add(at(across, along));
    lines += 2;
  }

  constexpr float kMost = std::numeric_limits<float>::max();
  const auto boxOf = [&](int column, int row, int cells) {
    Box b{kMost, kMost, kMost, -kMost, -kMost, -kMost};
    for (int r = row; r <= std::min(row + cells, side - 1); ++r)
      for (int c = column; c <= std::min(column + cells, side - 1); ++c) {
        const std::size_t i = at(c, r);
        b = {std::min(b.minX, x[i]), std::min(b.minY, y[i]), std::min(b.minZ, z[i]),
             std::max(b.maxX, x[i]), std::max(b.maxY, y[i]), std::max(b.maxZ, z[i])};
      }
    return b;
  };
  bounds = boxOf(0, 0, side - 1);
  for (int row = 0; row < side - 1; row += kPartCells)
    for (int column = 0; column < side - 1; column += kPartCells) {
      parts.push_back(boxOf(column, row, kPartCells));
      std::size_t peak = at(column, row);
      for (int r = row; r <= std::min(row + kPartCells, side - 1); ++r)
        for (int c = column; c <= std::min(column + kPartCells, side - 1); ++c)
          if (z[at(c, r)] > z[peak]) peak = at(c, r);
      peaks.push_back(static_cast<std::uint32_t>(peak));
    }
}

}  // namespace trimtab
