#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "trimtab/frame/terrain_index.h"

namespace trimtab {

/// Trees of static levels of detail (document E), one a tile of scenery, as flat arrays with one entry a
/// node; meshes are not here. A node's mesh replaces all that its children draw. Borders between nodes, tiles
/// and holes are the same in every level, so any cut through the trees is closed: neighbours need not agree.
struct StaticLodIndex {
  static constexpr std::uint32_t kNone = 0xffffffffu;

  struct Node {
    std::array<std::uint32_t, 2> children{kNone, kNone};  ///< both or none; they stand after their parent
    std::uint32_t tile = 0;
    std::uint32_t triangles = 0;
    std::uint8_t depth = 0;      ///< 0 at the root
    bool lockedMinimum = false;  ///< could not reach n: what is left is fixed by its borders
  };

  LocalFrame frame;
  std::vector<std::uint32_t> roots;  ///< one a tile
  std::vector<Node> nodes;
  std::vector<Box> bounds;       ///< of everything this node or any descendant draws, local frame
  std::vector<float> rmsErrorM;  ///< vertical, against the source triangles below; monotone up the tree
  std::vector<float> maxErrorM;  ///< likewise the largest
  /// How far borders of materials move sideways on airports, 0 elsewhere; monotone too.
  std::vector<float> borderErrorM;
  std::vector<float> slopeMax;  ///< steepest triangle of this node or a descendant, rise over run

  std::size_t size() const { return nodes.size(); }
};

}  // namespace trimtab
