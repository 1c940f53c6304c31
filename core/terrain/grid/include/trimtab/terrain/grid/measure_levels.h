#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "trimtab/terrain/grid/post_geometry.h"

namespace trimtab::terrain {

/// Slope of the steepest triangle in each cell of each level, whichever way the cell is triangulated: rise
/// over run x 16, rounded up, at most 255. The cells of a level are stored row by row, kTileCells per tile
/// and side; levels follow each other from the finest.
struct CellSlopes {
  static constexpr double kStepsPerUnit = 16;

  std::vector<std::size_t> firstOfLevel;  ///< one more than levels: the last is the size
  std::vector<std::uint8_t> cells;

  explicit CellSlopes(const TerrainIndex& index);
  std::size_t at(const TerrainIndex& index, std::uint32_t level, std::uint32_t row,
                 std::uint32_t column) const {
    return firstOfLevel[level] + std::size_t{row} * index.levels[level].columns * TerrainIndex::kTileCells +
           column;
  }
};

/// Fills in bounds, cones, errorM and slopeMax of an index made by makeLevels, and the slopes. Every level is
/// compared with all posts, so that errors are true maxima, plus bounds for the earth's curvature and for
/// rounding. Returns false if `carryOn` cancelled it.
bool measureLevels(const PostGrid& posts, std::span<const float> heights, const PostGeometry& geometry,
                   TerrainIndex& index, CellSlopes& slopes, const std::function<bool(double)>& carryOn);

}  // namespace trimtab::terrain
