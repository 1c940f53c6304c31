#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <span>
#include <vector>

#include "trimtab/terrain/elevation/source.h"
#include "trimtab/terrain/scenery/raster.h"

namespace trimtab::terrain {

/// Reads rows of heights from scenery, and from elevation at the posts that no triangle covers. Elevation is
/// bilinear between its own posts. Around the scenery its difference from the elevation fades out over 32
/// posts, like a membrane, so that no step is left. The result does not depend on the order of the calls.
/// About 180 rows and 2^20 posts are held in memory.
class BlendedRows {
 public:
  /// The raster must outlive it.
  BlendedRows(const SceneryRaster& scenery, std::unique_ptr<ElevationSource> elevation)
      : scenery_(scenery), elevation_(std::move(elevation)) {}

  /// Fills `heights` with rows [first, first + rows), NaN at posts where neither source has a height, and
  /// `reached` with 1 at posts inside a tile's rectangle or the elevation. Rows that are read in order are
  /// computed once; reading an earlier row starts again from the first one.
  Result<Done> read(std::uint32_t first, std::uint32_t rows, std::span<float> heights,
                    std::span<std::uint8_t> reached);

 private:
  struct Row {
    std::vector<float> heights, difference;  ///< scenery minus elevation; empty if nothing is blended
    std::vector<std::uint8_t> away, reached;
    std::vector<std::uint32_t> band;  ///< columns over which the difference fades out
  };
  Row& row(std::uint32_t number) { return rows_[number - firstRow_]; }
  /// Returns the next row to the north (1) or south (-1); null if there is none or it has been released.
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
  std::deque<std::vector<float>> elevationRows_;  ///< from firstElevationRow_ on
  std::uint32_t firstElevationRow_ = 0;
  std::deque<Row> rows_;
  std::uint32_t firstRow_ = 0;
  // The number of rows from the south that each step has done.
  std::uint32_t read_ = 0, bordered_ = 0, spread_ = 0, relaxing_ = 0, finished_ = 0;
};

}  // namespace trimtab::terrain
