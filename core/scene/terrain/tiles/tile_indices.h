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
TileIndices makeTileIndices();

/// A tile by every `step`-th post, numbered row by row: (32 / step + 1)^2 vertices, diagonals as the levels
/// have them.
std::vector<std::uint16_t> makeCoarseIndices(int step);

}  // namespace trimtab::scene
