#pragma once

#include <algorithm>
#include <vector>

#include "tests/core/terrain/elevation/rasters.h"
#include "trimtab/terrain/ground/build.h"

/// Land to make a ground's pyramid of, and levels of it as one picture.
namespace trimtab::test {

struct GroundLand {
  terrain::HeightGrid grid;
  std::vector<std::uint8_t> voids;
  terrain::PostGeometry geometry;
  std::unique_ptr<terrain::GridHeights> heights;

  GroundLand(std::uint32_t columns, std::uint32_t rows, double west = 11.3, double south = 46.2,
             double step = 1.0 / 1200)
      : GroundLand(terrain::PostGrid{west, south, step, step, columns, rows}) {}
  explicit GroundLand(const terrain::PostGrid& posts) : grid{posts, {}, 0, {}}, geometry(posts) {
    for (std::uint32_t r = 0; r < posts.rows; ++r)
      for (std::uint32_t c = 0; c < posts.columns; ++c)
        grid.heights.push_back(static_cast<float>(900 + 700 * std::sin(c * 0.031) * std::cos(r * 0.027) +
                                                  60 * std::sin(c * 0.3 + r * 0.2)));
  }

  terrain::GroundSources sources() {
    heights = std::make_unique<terrain::GridHeights>(grid, voids);
    terrain::GroundSources sources;
    sources.heights = heights.get();
    sources.geometry = &geometry;
    return sources;
  }
};

struct Picture {
  std::uint32_t columns = 0, rows = 0;
  std::vector<terrain::GroundTexel> texels;
  const terrain::GroundTexel& at(std::uint32_t column, std::uint32_t row) const {
    return texels[std::size_t{row} * columns + column];
  }
  friend bool operator==(const Picture&, const Picture&) = default;
};

inline Picture readLevel(const terrain::GroundPyramid& pyramid, std::uint32_t level) {
  const auto& size = pyramid.shape().levels[level];
  Picture picture{size.columns, size.rows, {}};
  picture.texels.resize(std::size_t{size.columns} * size.rows);
  for (std::uint32_t row = 0; row < size.tileRows(); ++row)
    for (std::uint32_t column = 0; column < size.tileColumns(); ++column) {
      const auto tile = pyramid.readTile(level, column, row);
      if (!tile) return {};
      for (std::uint32_t r = row * 256; r < std::min((row + 1) * 256, size.rows); ++r)
        for (std::uint32_t c = column * 256; c < std::min((column + 1) * 256, size.columns); ++c)
          picture.texels[std::size_t{r} * size.columns + c] = (*tile)[(r % 256) * 256 + c % 256];
    }
  return picture;
}

}  // namespace trimtab::test
