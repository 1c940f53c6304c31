#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "trimtab/terrain/grid/post_grid.h"
#include "trimtab/terrain/scenery/catalogue.h"

namespace trimtab::terrain {

/// Samples the triangles of scenery at the posts of a grid. The result is the same whichever rows are read
/// together.
class SceneryRaster {
 public:
  /// The catalogue must outlive it.
  SceneryRaster(const SceneryCatalogue& catalogue, const PostGrid& posts);

  const PostGrid& posts() const { return posts_; }
  /// Fills `heights` with the surface at the posts of rows [first, first + rows): the highest if there are
  /// several, NaN if there is none. Heights are rounded to a centimetre; tiles are exact to some millimetres.
  /// Fills `image`, unless it is empty, with the material's colour as RGBA, alpha 0 where there is no
  /// surface.
  Result<Done> read(std::uint32_t first, std::uint32_t rows, std::span<float> heights,
                    std::span<std::uint8_t> image = {}) const;
  /// Fills `posts` with 1 at the posts of a row that lie in a tile's rectangle, 0 at others.
  void reached(std::uint32_t row, std::span<std::uint8_t> posts) const;

 private:
  /// The posts inside a tile's rectangle; `end` is one past the last.
  struct Span {
    std::uint32_t firstColumn, endColumn, firstRow, endRow;
  };
  const SceneryCatalogue& catalogue_;
  PostGrid posts_;
  double turn_;              ///< degrees to add to the catalogue's longitudes
  std::vector<Span> spans_;  ///< per tile
};

}  // namespace trimtab::terrain
