#pragma once

#include <array>
#include <span>
#include <vector>

#include "trimtab/frame/terrain_index.h"

namespace trimtab {

/// Holds what the horizon reads first of any surface.
struct Relief {
  Vec3 origin;  ///< metres, local frame; all other coordinates are relative to it
  Box bounds;
  /// Largest absolute coordinate. Negative if the surface is not known: it hides nothing and is never hidden.
  float reach = -1;
  std::array<float, 3> peak{};  ///< the highest vertex
};

/// Returns an upper bound of how far a line's corners lie beside its chord in plan, metres.
float furthestBeside(std::span<const float> x, std::span<const float> y);

/// A tile's drawn surface in the form that the horizon reads: a square of posts, rows from the south. It is
/// made once per tile.
///
/// Each triangle's corners must be posts of one block of kBlockCells x kBlockCells cells, and along every
/// even row and column inside the tile all edges from post to post must be drawn.
struct TileRelief : Relief {
  static constexpr int kBlockCells = 2;
  static constexpr int kPartCells = 8;   ///< cells per side of a part, tested as a box before its blocks
  static constexpr int kMostPosts = 65;  ///< per side; a larger tile counts as not known
  static constexpr int kGoOn =
      2;  ///< corners with which a line continues its western or southern neighbour's

  // The members that most tests read come first and together.
  int side = 0;                    ///< posts
  int lines = 0;                   ///< lines of posts that may hide others: rows, then as many columns
  int lineStep = 1;                ///< posts from one line to the next
  std::array<float, 2> lineTop{};  ///< the highest corner of the rows, and of the columns
  float besideM = 0;               ///< furthest that a line's corner lies beside its chord in plan, metres
  std::vector<float> lineXyz;      ///< for each line all x, then all y, then all z
  std::vector<float> goOn;         ///< for each line x, y, z of the kGoOn corners after its first

  /// A square of kPartCells x kPartCells cells, fewer at the last borders.
  struct Part {
    static constexpr int kMostBlocks = (kPartCells / kBlockCells) * (kPartCells / kBlockCells);
    /// Boxes of its blocks, the highest first, padded with the last one.
    alignas(64) std::array<float, kMostBlocks> minX, maxX, minY, maxY, top;
    int blocks;
    Box box;
    std::array<float, 3> peak;  ///< its highest post
  };
  std::vector<Part> parts;     ///< the highest first
  std::vector<float> x, y, z;  ///< side * side, metres; only `finish` reads them

  /// Computes everything else from side, x, y and z. `step` is the number of posts from one line to the next
  /// and must be even. If a coordinate is not finite the surface counts as not known.
  void finish(int step);
};

}  // namespace trimtab
