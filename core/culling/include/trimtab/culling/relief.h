#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "trimtab/frame/terrain_index.h"

namespace trimtab {

/// What the horizon first asks of any surface.
struct Relief {
  Vec3 origin;  ///< of all that follows, local frame
  Box bounds;   ///< metres
  /// No coordinate is further from 0; below 0: not known, hides nothing and is never hidden.
  float reach = -1;
  std::array<float, 3> peak{};  ///< the highest vertex
};

/// How far from the way between its ends a line leads, metres.
float furthestBeside(std::span<const float> x, std::span<const float> y);

/// A tile's drawn surface as the horizon reads it, made once a tile.
///
/// A square of posts, rows from south. What is drawn between them may be any triangles whose corners are
/// posts of one block of kBlockCells x kBlockCells cells; but along a line of even row or column inside the
/// tile, all edges from post to post are drawn.
struct TileRelief : Relief {
  static constexpr int kBlockCells = 2;
  static constexpr int kPartCells = 8;  ///< cells a side of a part, which is tried as a box before its blocks
  static constexpr int kMostPosts = 65;  ///< of a side: a larger tile is not known
  static constexpr int kGoOn = 2;        ///< corners of a line that the one before it may go on with

  // What most tiles need of all this stands together.
  int side = 0;                    ///< posts
  int lines = 0;                   ///< that may hide what is behind them: rows of posts, then as many columns
  int lineStep = 1;                ///< posts from one to the next
  std::array<float, 2> lineTop{};  ///< the highest corner of the rows, and of the columns
  float besideM = 0;               ///< no corner of a line is further from the way between its ends, in plan
  std::vector<float> lineXyz;      ///< of each line all x, all y, all z
  std::vector<float> goOn;         ///< of each line x, y and z of kGoOn corners after its first

  /// A square of kPartCells x kPartCells cells, less beside the last borders.
  struct Part {
    static constexpr int kMostBlocks = (kPartCells / kBlockCells) * (kPartCells / kBlockCells);
    /// Boxes of its blocks, the highest first; after the last that one again.
    alignas(64) std::array<float, kMostBlocks> minX, maxX, minY, maxY, top;
    int blocks;
    Box box;
    std::array<float, 3> peak;  ///< its highest post
  };
  std::vector<Part> parts;     ///< the highest first
  std::vector<float> x, y, z;  ///< side * side, metres; read by `finish` alone, and of no use after it

  /// Completes the rest from side, x, y and z. `step`: from one line to the next, posts, even. A surface that
  /// is not all of finite numbers is not known.
  void finish(int step);
};

}  // namespace trimtab
