#pragma once

#include <cstdint>
#include <vector>

#include "trimtab/terrain/mesher_triangulation.h"

namespace trimtab::terrain {

/// Puts triangles into an order in which each shares an edge with one shortly before, so that they pack well:
/// nearly as well as in the order of meshopt_optimizeVertexCacheStrip, in a tenth of its time. Keeps its
/// storage from mesh to mesh.
class TriangleOrder {
 public:
  /// Three indices a triangle.
  void order(const Triangulation& mesh, std::vector<std::uint32_t>& indices);

 private:
  /// Neighbours of a triangle that are not in the order yet, or kDone; the first entry is for what lies
  /// beyond the border.
  std::vector<std::uint8_t> open_;
};

}  // namespace trimtab::terrain
