#pragma once

#include <algorithm>
#include <cstdint>

#include "trimtab/terrain/grid/post_geometry.h"
#include "trimtab/terrain/grid/post_grid.h"

namespace trimtab::terrain {

/// Slopes towards east and north, rise over run.
struct PostGradient {
  double east = 0, north = 0;
};

/// Returns a component of a unit vector x 127, rounded.
inline std::int8_t byteOf(double component) {
  return static_cast<std::int8_t>(static_cast<int>(component * 127 + 127.5) - 127);
}

/// Returns the slopes at a post from its eight neighbours, with the four nearest weighted twice; at the
/// grid's border, from those that exist. `height(row, column)` returns metres.
template <class Height>
PostGradient gradientAt(const PostGrid& posts, const PostGeometry& geometry, std::uint32_t row,
                        std::uint32_t column, const Height& height) {
  const std::uint32_t s = row == 0 ? 0 : row - 1, n = std::min(row + 1, posts.rows - 1);
  const std::uint32_t w = column == 0 ? 0 : column - 1, e = std::min(column + 1, posts.columns - 1);
  const double eastward =
      (height(s, e) - height(s, w)) + 2 * (height(row, e) - height(row, w)) + (height(n, e) - height(n, w));
  const double northward = (height(n, w) - height(s, w)) + 2 * (height(n, column) - height(s, column)) +
                           (height(n, e) - height(s, e));
  // Columns meet at a pole.
  const double dx = std::max(geometry.columnM(row), 1e-3) * std::max(e - w, 1u),
               dy = geometry.rowM(row) * std::max(n - s, 1u);
  return {eastward / (4 * dx), northward / (4 * dy)};
}

}  // namespace trimtab::terrain
