#pragma once

#include <array>
#include <cstdint>

#include "core/scene/surface/surfaces_in_use.h"
#include "trimtab/culling/mesh_relief.h"

namespace trimtab::scene {

/// Makes lids of boxes, which stand for nodes whose surfaces are not made yet. No part of a node, or of what
/// is below it in the tree, is higher over any place than its lid, so what hides the lid hides them. A lid
/// itself hides nothing.
class BoxLids {
 public:
  void reset(std::size_t nodes) { lids_.reset(nodes); }
  /// Returns the lid of a node's box, valid until the next `forgetOthers`.
  const MeshRelief* of(std::uint32_t node, const Box& box) {
    if (const MeshRelief* made = lids_.find(node)) return made;
    MeshRelief& lid = lids_.make(node);
    const Vec3 middle{0.5 * (double{box.minX} + box.maxX), 0.5 * (double{box.minY} + box.maxY),
                      double{box.maxZ}};
    constexpr float kRounding = 0.1f;
    const float x = static_cast<float>(box.maxX - middle.x) + kRounding,
                y = static_cast<float>(box.maxY - middle.y) + kRounding;
    // A box that no row or column of posts divisible by the step crosses has no lines that might hide.
    constexpr int kStep = 4;
    const std::array<ReliefVertex, 4> corners{{{-x, -y, kRounding, 1, 1},
                                               {x, -y, kRounding, 2, 1},
                                               {x, y, kRounding, 2, 2},
                                               {-x, y, kRounding, 1, 2}}};
    constexpr std::array<std::uint16_t, 6> kTriangles{0, 1, 2, 0, 2, 3};
    makeMeshRelief(corners, kTriangles, middle, kStep, lid);
    return &lid;
  }
  void forgetOthers(const LevelCut& cut) { lids_.forgetOthers(cut); }

 private:
  SurfacesInUse<MeshRelief> lids_;
};

}  // namespace trimtab::scene
