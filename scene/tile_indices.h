#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace trimtab::scene {

/// Triangles of a tile for each combination of coarser sides (bits W=1, E=2, S=4, N=8) in one shared buffer.
struct TileIndices {
  struct Range {
    std::uint32_t first = 0, count = 0;  ///< indices
  };
  std::vector<std::uint16_t>
      indices;                    ///< into the tile's 33 x 33 vertices; counter-clockwise seen from above
  std::array<Range, 16> variant;  ///< by `coarser` bits
};

/// On a coarser side the odd vertices fall onto their even neighbour, so that the border's edges are the
/// coarser tile's; triangles that collapse are left out.
///
/// `step` 2, 4, 8, ...: the tile by every so-manyth post, for occluders. Sides are then coarse anyway.
TileIndices makeTileIndices();
std::vector<std::uint16_t> makeCoarseIndices(int step);

}  // namespace trimtab::scene
