#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "trimtab/terrain/grid/post_geometry.h"

namespace trimtab::terrain {

/// Steepest triangle of each cell of each level, with either kind of border, 16 steps a unit, rounded up, 255
/// for more. A level has kTileCells x its tiles in columns and rows, row by row; levels follow each other
/// from the finest.
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

/// Fills bounds, cones, errorM and slopeMax of an index made by makeLevels, and the slopes. All posts are
/// looked at for every level: the errors are true maxima, plus bounds for the earth's curvature and the
/// rounding. False: cancelled.
bool measureLevels(const PostGrid& posts, std::span<const float> heights, const PostGeometry& geometry,
                   TerrainIndex& index, CellSlopes& slopes, const std::function<bool(double)>& carryOn);

}  // namespace trimtab::terrain
