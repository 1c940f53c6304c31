#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "trimtab/terrain/format/ground_pyramid.h"
#include "trimtab/terrain/grid/post_grid.h"
#include "trimtab/terrain/ground/triangles.h"

namespace trimtab::terrain {

/// Texels of level 0 that are coloured together.
struct GroundWindow {
  std::uint32_t column = 0, row = 0, columns = 0, rows = 0;
};

/// Paints the ground's triangles: what lies in the middle of a texel gives its colour, later ones on top.
/// Lines (roads, railways, streams) are a texel wide where they are narrower, so that none breaks; and in
/// coarser levels too, as strong as half a texel of them is wide: they fade once they are narrower than that,
/// as half a picture element does.
class GroundPaint {
 public:
  /// `side`: texels of level 0 of a block.
  GroundPaint(const PostGrid& posts, const GroundShape& shape, std::uint32_t side)
      : posts_(posts), shape_(shape), side_(side) {}

  /// All that a block's triangles may reach, lines as wide as its coarsest level makes them.
  Rectangle degreesOf(std::uint32_t blockColumn, std::uint32_t blockRow) const;
  /// Over RGBA of a window of level 0: what is painted gets alpha 255.
  void paint(std::span<const GroundTriangle> triangles, const GroundWindow& window,
             std::span<std::uint8_t> rgba) const;
  /// Lines alone, over a tile of a level; `covered(texel of the tile)` are left as they are.
  void paintLines(std::span<const GroundTriangle> triangles, std::uint32_t level, std::uint32_t tileColumn,
                  std::uint32_t tileRow, std::span<const std::uint8_t> covered, GroundTile& tile) const;

 private:
  struct Corner {
    double x, y;
  };
  /// In texels of a level.
  std::array<Corner, 3> cornersOf(const GroundTriangle& triangle, double scale) const;

  PostGrid posts_;
  GroundShape shape_;
  std::uint32_t side_;
};

}  // namespace trimtab::terrain
