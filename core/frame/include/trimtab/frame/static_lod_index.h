#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "trimtab/frame/terrain_index.h"

namespace trimtab {

/// The static LOD trees of document E, one per tile of scenery, as flat arrays with one entry per node,
/// without their meshes. A node's mesh replaces all that its children draw. Borders between nodes, tiles and
/// holes are the same in every level, so any cut through the trees has no gaps, whatever the neighbours draw.
struct StaticLodIndex {
  static constexpr std::uint32_t kNone = 0xffffffffu;

  struct Node {
    std::array<std::uint32_t, 2> children{kNone, kNone};  ///< both or none; they come after their parent
    std::uint32_t tile = 0;
    std::uint32_t triangles = 0;
    std::uint8_t depth = 0;      ///< 0 at the root
    bool lockedMinimum = false;  ///< has more than n triangles, because its borders are fixed
  };

  LocalFrame frame;
  std::vector<std::uint32_t> roots;  ///< one per tile
  std::vector<Node> nodes;
  std::vector<Box> bounds;       ///< of everything this node or any descendant draws, local frame
  std::vector<float> rmsErrorM;  ///< vertical RMS error against the source triangles; rises up the tree
  std::vector<float> maxErrorM;  ///< the worst vertical error; rises up the tree
  /// Greatest sideways shift of the borders of materials on airports, metres; 0 elsewhere. Rises up the tree.
  std::vector<float> borderErrorM;
  std::vector<float> slopeMax;  ///< steepest triangle of this node or a descendant, rise over run

  std::size_t size() const { return nodes.size(); }
};

}  // namespace trimtab
