#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace trimtab::scene {

/// The triangles of a tile for each combination of coarser sides (BorderMask), in one shared buffer.
struct TileIndices {
  struct Range {
    std::uint32_t first = 0, count = 0;  ///< indices
  };
  std::vector<std::uint16_t>
      indices;                    ///< into the tile's 33 x 33 vertices; counter-clockwise seen from above
  std::array<Range, 16> variant;  ///< by the mask's bits
};

/// Makes them. On a coarser side the odd vertices fall onto their even neighbours, so the border's edges are
/// the coarser tile's; triangles that collapse are left out.
TileIndices makeTileIndices();

/// Returns the triangles of a tile by every `step`-th post, numbered row by row: (32 / step + 1)^2 vertices,
/// with the diagonals that the levels have.
std::vector<std::uint16_t> makeCoarseIndices(int step);

}  // namespace trimtab::scene
