#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "trimtab/frame/terrain_index.h"
#include "trimtab/units/result.h"

namespace trimtab::terrain {

/// Where the posts of a regular WGS84 grid are: degrees, rows from south, columns from west. Longitudes do
/// not wrap: a grid across the date line goes on past 180.
struct PostGrid {
  double west = 0, south = 0;  ///< of post (0, 0)
  double stepLongitude = 0, stepLatitude = 0;
  std::uint32_t columns = 0, rows = 0;

  std::size_t size() const { return std::size_t{columns} * rows; }
  double longitude(double column) const { return west + column * stepLongitude; }
  double latitude(double row) const { return south + row * stepLatitude; }
  /// Of a longitude in any turn, as near to the grid's middle as turns allow: negative west of the grid.
  double columnOf(double longitudeDeg) const;
  double rowOf(double latitudeDeg) const { return (latitudeDeg - south) / stepLatitude; }

  friend bool operator==(const PostGrid&, const PostGrid&) = default;
};

/// What the grid of a database may be: degrees, and posts a side.
struct PostLimits {
  static constexpr double kWest = 540, kLeastStep = 1e-9, kMostStepLongitude = 180, kMostStepLatitude = 90;
  static constexpr double kPastPole = 1e-6;  ///< of the northernmost row, by rounding
  static constexpr std::uint32_t kMostSide = 1u << 20;
};
/// What of a grid no database can hold; `where` names its source.
Findings beyondLimits(const PostGrid& posts, const std::string& where);
/// Rows that go on past a pole, as rounded steps make them, end on it.
PostGrid upToPoles(PostGrid posts);

/// Heights in metres, row by row; NaN is a void until voids are filled.
struct HeightGrid {
  PostGrid posts;
  std::vector<float> heights;
  std::uint64_t outside = 0;  ///< voids that no source reaches: the corners about a raster that stands askew
  std::vector<std::uint8_t>
      image;  ///< RGBA a post, alpha 0 where the image has nothing; empty without an image
};

/// The levels and their links for a grid of posts; bounds, errors and slopes are sized but not measured.
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
