#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "trimtab/frame/terrain_index.h"
#include "trimtab/units/result.h"

namespace trimtab::terrain {

/// The posts of a regular WGS84 grid: degrees, rows from south, columns from west. Longitudes do not wrap: a
/// grid across the date line continues beyond 180 degrees.
struct PostGrid {
  double west = 0, south = 0;  ///< of post (0, 0)
  double stepLongitude = 0, stepLatitude = 0;
  std::uint32_t columns = 0, rows = 0;

  std::size_t size() const { return std::size_t{columns} * rows; }
  double longitude(double column) const { return west + column * stepLongitude; }
  double latitude(double row) const { return south + row * stepLatitude; }
  /// Returns the column of a longitude, which is first shifted by whole turns to be nearest to the grid's
  /// middle; negative west of the grid.
  double columnOf(double longitudeDeg) const;
  double rowOf(double latitudeDeg) const { return (latitudeDeg - south) / stepLatitude; }

  friend bool operator==(const PostGrid&, const PostGrid&) = default;
};

/// Limits of a database's grid: degrees, and posts per side.
struct PostLimits {
  static constexpr double kWest = 540, kLeastStep = 1e-9, kMostStepLongitude = 180, kMostStepLatitude = 90;
  static constexpr double kPastPole =
      1e-6;  ///< how far rounding may put the northernmost row beyond the pole
  static constexpr std::uint32_t kMostSide = 1u << 20;
};
/// Reports what in a grid exceeds PostLimits; `where` names its source.
Findings beyondLimits(const PostGrid& posts, const std::string& where);
/// Returns the grid with its rows ending at the poles, if rounded steps took them beyond.
PostGrid upToPoles(PostGrid posts);

/// Heights in metres, row by row; NaN is a void until voids are filled.
struct HeightGrid {
  PostGrid posts;
  std::vector<float> heights;
  std::uint64_t outside = 0;  ///< voids that no source reaches: the corners around a rotated raster
  std::vector<std::uint8_t>
      image;  ///< RGBA per post, alpha 0 where the image has no colour; empty if there is no image
};

/// Makes the levels and links of the tiles of a grid; bounds, errors and slopes are allocated, not measured.
TerrainIndex makeLevels(const PostGrid& posts);

/// The posts of a tile: vertex (i, j) is post (row(j), column(i)).
struct TilePosts {
  std::uint32_t level = 0, tileColumn = 0, tileRow = 0;
  std::uint32_t lastColumn = 0, lastRow = 0;

  TilePosts(const TerrainIndex& index, const PostGrid& posts, std::uint32_t node);
  std::uint32_t column(std::uint32_t i) const { return clamped(tileColumn, i, lastColumn); }
  std::uint32_t row(std::uint32_t j) const { return clamped(tileRow, j, lastRow); }

 private:
  std::uint32_t clamped(std::uint32_t tile, std::uint32_t i, std::uint32_t last) const {
    const std::uint64_t post = (std::uint64_t{tile} * TerrainIndex::kTileCells + i) << level;
    return post < last ? static_cast<std::uint32_t>(post) : last;
  }
};

}  // namespace trimtab::terrain
