#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace trimtab::terrain {

/// Orders triangles so that each shares an edge with one shortly before it. They then pack nearly as well as
/// in the order of meshopt_optimizeVertexCacheStrip, which takes ten times as long. Keeps its storage from
/// mesh to mesh.
class TriangleOrder {
 public:
  /// `twins` are those of PolygonMesher::triangles, three per triangle. Fills `order` with one half-edge per
  /// triangle, in drawing order: the triangle is to be drawn from the corner that the half-edge leaves.
  void order(std::span<const std::int32_t> twins, std::vector<std::int32_t>& order);

 private:
  /// Neighbours of a triangle that are not in the order yet, or kDone; the first entry is for what lies
  /// beyond the border.
  std::vector<std::uint8_t> open_;
};

}  // namespace trimtab::terrain
