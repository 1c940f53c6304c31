#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "trimtab/terrain/grid/post_grid.h"
#include "trimtab/terrain/scenery/catalogue.h"

namespace trimtab::terrain {

/// Scenery's triangles on rows of posts, whichever rows are asked for and in whatever portions: the same.
class SceneryRaster {
 public:
  /// The catalogue must outlive it.
  SceneryRaster(const SceneryCatalogue& catalogue, const PostGrid& posts);

  const PostGrid& posts() const { return posts_; }
  /// Rows [first, first + rows): the surface at each post, the highest where there are several, NaN where
  /// there is none. Heights to a centimetre: tiles hold theirs to some millimetres. `image`, where wanted:
  /// the material's colour, RGBA, alpha 0 where there is no surface.
  Result<Done> read(std::uint32_t first, std::uint32_t rows, std::span<float> heights,
                    std::span<std::uint8_t> image = {}) const;
  /// 1 at the posts of a row that lie in some tile's rectangle.
  void reached(std::uint32_t row, std::span<std::uint8_t> posts) const;

 private:
  /// Posts inside a tile's rectangle, the last not among them.
  struct Span {
    std::uint32_t firstColumn, endColumn, firstRow, endRow;
  };
  const SceneryCatalogue& catalogue_;
  PostGrid posts_;
  double turn_;              ///< of the catalogue's longitudes
  std::vector<Span> spans_;  ///< one a tile
};

}  // namespace trimtab::terrain
