#pragma once

#include <cstdint>
#include <vector>

#include "trimtab/terrain/objects/source_model.h"
#include "trimtab/units/linear.h"

namespace trimtab::terrain {

/// Triangles in a tree of boxes, for the one nearest to a point.
class TriangleTree {
 public:
  /// The mesh must have a triangle, and all its indices and positions must be right.
  explicit TriangleTree(const SourceMesh& mesh);

  struct Nearest {
    double distance = 0;
    std::uint32_t triangle = 0;  ///< as the tree orders them
  };
  /// `guess`: a triangle that may be near; it makes the search shorter.
  Nearest nearest(Vec3 point, std::uint32_t guess = 0) const;
  double distanceTo(Vec3 point, std::uint32_t triangle) const;

 private:
  struct Node {
    Vec3 low, high;
    std::uint32_t first = 0, count = 0;  ///< triangles of a leaf
    std::uint32_t right = 0;             ///< the left child follows its parent
  };
  struct Triangle {
    Vec3 corner[3];
  };
  void build(std::uint32_t first, std::uint32_t count);

  std::vector<Node> nodes_;
  std::vector<Triangle> triangles_;
};

/// Returns a distance that no point of the triangles of `from` exceeds from those of `to`, at most 2 % or
/// `slackM` more than the farthest point's.
///
/// A triangle is divided while it may hold a farther point than the farthest found so far. What it may hold
/// is bounded twice: no point is farther than the middle by more than the way to the farthest corner; and the
/// distance to one triangle, a convex set, is largest at a corner. After a number of pieces that grows with
/// the mesh, the bound is returned as it is, which may be more than 2 % too large.
double farthestFrom(const SourceMesh& from, const TriangleTree& to, double slackM);

}  // namespace trimtab::terrain
