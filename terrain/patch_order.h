#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace trimtab::terrain {

/// Puts triangles into an order in which each shares an edge with one shortly before, so that they pack well:
/// nearly as well as in the order of meshopt_optimizeVertexCacheStrip, in a third of its time. Keeps its
/// storage from mesh to mesh.
class TriangleOrder {
 public:
  /// `indices`: three a triangle, of vertices below `vertices`; every edge in each direction once at most.
  void order(std::span<const std::uint32_t> indices, std::size_t vertices, std::uint32_t* ordered);

 private:
  /// The half-edge on the other side of each; half-edge i leads from vertex i of the triangles to the next.
  void findTwins(std::span<const std::uint32_t> indices, std::size_t vertices);

  std::vector<std::uint32_t> start_;           ///< of each vertex, in the lists of half-edges that leave it
  std::vector<std::uint32_t> leaving_, goal_;  ///< those, and where they lead
  std::vector<std::uint32_t> twin_;
  std::vector<std::uint8_t> done_;  ///< one a triangle
};

}  // namespace trimtab::terrain
