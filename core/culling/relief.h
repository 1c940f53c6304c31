#pragma once

#include <cstdint>
#include <vector>

#include "trimtab/frame/terrain_index.h"

namespace trimtab {

/// What the horizon first asks of any surface.
struct Relief {
  Vec3 origin;      ///< of all that follows, local frame
  Box bounds;       ///< metres
  float reach = 0;  ///< no coordinate is further from 0
};

/// A tile's drawn surface as the horizon reads it, made once a tile.
///
/// A square of posts, rows from south. What is drawn between them may be any triangles whose corners are
/// posts of one block of kBlockCells x kBlockCells cells; but along a line of even row or column inside the
/// tile, all edges from post to post are drawn.
struct TileRelief : Relief {
  static constexpr int kBlockCells = 2;
  static constexpr int kPartCells = 8;  ///< cells a side of a part, which is tried as a box before its blocks

  int side = 0;                            ///< posts
  std::vector<float> x, y, z;              ///< side * side, metres
  int lines = 0;                           ///< rows and columns of posts that may hide what is behind them
  std::vector<float> lineX, lineY, lineZ;  ///< lines * side
  std::vector<Box> parts;                  ///< partsPerSide() squared, rows from south
  std::vector<std::uint32_t> peaks;        ///< the highest post of each part

  int partsPerSide() const { return (side - 1 + kPartCells - 1) / kPartCells; }
  /// Completes lines and boxes from side, x, y and z. `step`: from one line to the next, posts, even. A
  /// surface that is not all of finite numbers has neither: it hides nothing and is never hidden.
  void finish(int step);
};

}  // namespace trimtab
