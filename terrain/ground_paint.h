#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "trimtab/terrain/ground.h"
#include "trimtab/terrain/post_grid.h"
#include "trimtab/terrain/scenery_lines.h"

namespace trimtab::terrain {

/// Texels of level 0 that are coloured together.
struct GroundWindow {
  std::uint32_t column = 0, row = 0, columns = 0, rows = 0;
};

/// Paints scenery's triangles: what lies in the middle of a texel gives its colour, later ones on top. Lines
/// (roads, railways, streams) are a texel wide where they are narrower, so that none breaks; and in coarser
/// levels too, as strong as half a texel of them is wide: they fade once they are narrower than that, as
/// half a picture element does.
class GroundPaint {
 public:
  /// `side`: texels of level 0 of a block, in which they are found again. Triangles must outlive it.
  GroundPaint(std::span<const GroundTriangle> triangles, const PostGrid& posts, const GroundShape& shape,
              std::uint32_t side);

  bool empty() const { return triangles_.empty(); }
  /// Over RGBA of a block's window: what it paints gets alpha 255.
  void paint(std::uint32_t blockColumn, std::uint32_t blockRow, const GroundWindow& window,
             std::span<std::uint8_t> rgba) const;
  /// Lines alone, over a tile of a level inside a block; `covered(texel of the tile)` are left as they are.
  void paintLines(std::uint32_t blockColumn, std::uint32_t blockRow, std::uint32_t level,
                  std::uint32_t tileColumn, std::uint32_t tileRow, std::span<const std::uint8_t> covered,
                  GroundTile& tile) const;

 private:
  struct Corner {
    double x, y;
  };
  /// In texels of a level.
  std::array<Corner, 3> cornersOf(const GroundTriangle& triangle, double scale) const;
  std::span<const std::uint32_t> inBlock(std::uint32_t column, std::uint32_t row) const;

  std::span<const GroundTriangle> triangles_;
  PostGrid posts_;
  GroundShape shape_;
  std::uint32_t side_, columns_, rows_;
  std::vector<std::uint32_t> first_, found_;  ///< by block, in the order of painting
};

}  // namespace trimtab::terrain
