#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "trimtab/terrain/format/ground_pyramid.h"
#include "trimtab/terrain/grid/post_grid.h"
#include "trimtab/terrain/ground/triangles.h"

namespace trimtab::terrain {

/// A rectangle of texels of level 0 that is painted at once.
struct GroundWindow {
  std::uint32_t column = 0, row = 0, columns = 0, rows = 0;
};

/// Paints triangles: the last one that contains the middle of a texel gives its colour. Lines (roads,
/// railways, streams) are drawn at least one texel wide at every level, so that none is interrupted. At
/// coarser levels a line narrower than half a texel is blended in proportion to its width, so that it fades.
class GroundPaint {
 public:
  /// `side`: side of a block in texels of level 0.
  GroundPaint(const PostGrid& posts, const GroundShape& shape, std::uint32_t side)
      : posts_(posts), shape_(shape), side_(side) {}

  /// Returns the area whose triangles can affect a block, including lines widened at its coarsest level.
  Rectangle degreesOf(std::uint32_t blockColumn, std::uint32_t blockRow) const;
  /// Paints over RGBA of a window of level 0; painted texels get alpha 255.
  void paint(std::span<const GroundTriangle> triangles, const GroundWindow& window,
             std::span<std::uint8_t> rgba) const;
  /// Paints lines alone, over a tile of a level. Texels with `covered` other than 0 stay unchanged.
  void paintLines(std::span<const GroundTriangle> triangles, std::uint32_t level, std::uint32_t tileColumn,
                  std::uint32_t tileRow, std::span<const std::uint8_t> covered, GroundTile& tile) const;

 private:
  struct Corner {
    double x, y;
  };
  /// Returns the corners in texels of a level.
  std::array<Corner, 3> cornersOf(const GroundTriangle& triangle, double scale) const;

  PostGrid posts_;
  GroundShape shape_;
  std::uint32_t side_;
};

}  // namespace trimtab::terrain
