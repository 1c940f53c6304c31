#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <span>
#include <vector>

#include "trimtab/terrain/elevation/source.h"
#include "trimtab/terrain/scenery/raster.h"

namespace trimtab::terrain {

/// Rows of scenery, and at posts that no triangle covers the heights of elevation, bilinear between its
/// posts. Around what is scenery's the difference to it is spread over 32 posts (a membrane), so that there
/// is no step. What is read does not depend on how it is asked for; some 180 rows are in memory, and 2^20
/// posts more.
class BlendedRows {
 public:
  /// The raster must outlive it.
  BlendedRows(const SceneryRaster& scenery, std::unique_ptr<ElevationSource> elevation)
      : scenery_(scenery), elevation_(std::move(elevation)) {}

  /// Rows [first, first + rows), NaN where neither has a height; `reached`, one a post: 1 where a tile's
  /// rectangle or elevation reaches. Rows in order are made once; for an earlier one all is made again.
  Result<Done> read(std::uint32_t first, std::uint32_t rows, std::span<float> heights,
                    std::span<std::uint8_t> reached);

 private:
  struct Row {
    std::vector<float> heights, difference;  ///< from elevation; empty where nothing is blended
    std::vector<std::uint8_t> away, reached;
    std::vector<std::uint32_t> band;  ///< columns that the difference is spread over
  };
  Row& row(std::uint32_t number) { return rows_[number - firstRow_]; }
  /// Null where there is none, or it has been let go.
  const Row* beside(std::uint32_t number, int north) {
    const std::uint32_t at = number - firstRow_ + static_cast<std::uint32_t>(north);
    return at < rows_.size() ? &rows_[at] : nullptr;
  }
  double elevationAt(std::uint32_t row, std::uint32_t column) const;
  Result<Done> readElevation(std::uint32_t row);
  Result<Done> readScenery();
  void findBorder(std::uint32_t number);
  void spread();
  void relax(std::uint32_t number);
  Result<Done> advance();

  const SceneryRaster& scenery_;
  std::unique_ptr<ElevationSource> elevation_;
  std::deque<std::vector<float>> elevationRows_;  ///< those in hand
  std::uint32_t firstElevationRow_ = 0;
  std::deque<Row> rows_;
  std::uint32_t firstRow_ = 0;
  // Rows from the south that each step has done.
  std::uint32_t read_ = 0, bordered_ = 0, spread_ = 0, relaxing_ = 0, finished_ = 0;
};

}  // namespace trimtab::terrain
