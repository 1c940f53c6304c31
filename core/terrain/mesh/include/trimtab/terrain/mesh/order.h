#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace trimtab::terrain {

/// Puts triangles into an order in which each shares an edge with one shortly before, so that they pack well:
/// nearly as well as in the order of meshopt_optimizeVertexCacheStrip, in a tenth of its time. Keeps its
/// storage from mesh to mesh.
class TriangleOrder {
 public:
  /// `twins`: of PolygonMesher, three a triangle. `order`: of each triangle the half-edge from which it is to
  /// be drawn.
  void order(std::span<const std::int32_t> twins, std::vector<std::int32_t>& order);

 private:
  /// Neighbours of a triangle that are not in the order yet, or kDone; the first entry is for what lies
  /// beyond the border.
  std::vector<std::uint8_t> open_;
};

}  // namespace trimtab::terrain
