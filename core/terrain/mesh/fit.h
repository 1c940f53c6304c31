#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "errors.h"
#include "trimtab/terrain/mesh/triangulation.h"

namespace trimtab::terrain {

/// Flips edges and moves vertices of a mesh where that makes the sum of squared errors smaller. No post gets
/// further off than `bound`, which holds before; vertices on the mesh's border stay. Places are those of the
/// posts, at step 1.
class MeshFit {
 public:
  /// `sums`: one a triangle, if known; `worst` may be more than it is.
  MeshFit(Triangulation& mesh, const PostRows& posts, std::vector<PostSum> sums);
  void flipEdges(double bound);
  /// Vertices by height, each to the least squares about it, but none further than `own` from its post.
  void moveHeights(double bound, double own);
  /// One after the other by whole posts, where the squares promise to fall by `least` at least. After
  /// moveHeights.
  void moveAside(double bound, double least);

  PostSum sumOf(const Triangulation::Vertex& a, const Triangulation::Vertex& b,
                const Triangulation::Vertex& c, const bool border[3]) const {
    const Triangulation::Vertex* const corner[3] = {&a, &b, &c};
    return sumOfPosts(corner, border, posts_);
  }
  PostSum sumOf(std::int32_t t) const;
  /// Post less vertex.
  double offAt(const Triangulation::Vertex& v) const {
    return posts_.row(v.y)[v.x] - static_cast<double>(v.z);
  }
  /// As given, of now.
  std::vector<PostSum>& sums() { return sums_; }

 private:
  /// Over the posts of a triangle: products of the corners' shares w in its height, and of these and the
  /// residuals r. `wx[i]` is that of corner i and the next.
  struct Moments {
    double ww[3], wx[3], wr[3];
  };
  /// Over the posts about a vertex, and what moving it sideways does to them.
  struct Star {
    double rr = 0, wr = 0, ww = 0;
    double xx = 0, xy = 0, yy = 0, xz = 0, yz = 0, rx = 0, ry = 0;
    std::int64_t area = 0;
  };
  template <class Visit>
  void eachAbout(std::uint32_t v, const Visit& visit) const;
  bool tryFlip(std::int32_t t, int i, double bound);
  void measure(std::int32_t first, std::int32_t count);
  void raise(std::uint32_t v, float z);
  void keepBound(double bound, double rounding, std::span<const float> before);
  Star starOf(std::uint32_t v) const;
  /// Whether the triangles about a vertex would stay anticlockwise with it there: only then there are posts.
  bool mayStand(std::uint32_t v, const Triangulation::Vertex& there) const;
  void gather(std::uint32_t v, const Triangulation::Vertex& at);
  bool keeps(double rise, double bound) const;
  bool bestHeight(float was, double bound, float& z, double& squares) const;
  void tryAside(std::uint32_t v, double squares, double dx, double dy, double bound);

  Triangulation& mesh_;
  PostRows posts_;
  std::vector<PostSum> sums_;
  std::vector<Moments> moments_;      ///< one a triangle
  std::vector<std::int32_t> starts_;  ///< innerStarts
  /// What gather found. Residuals r at the posts about a vertex change by -w d where it rises by d. Four of
  /// the one, then four of the other; both are 0 where there is no post.
  std::vector<double> about_;
  std::size_t aboutCount_ = 0;
  double rr_ = 0, wr_ = 0, ww_ = 0;
};

/// Posts on a border are of no triangle; where there is a mesh on both sides they are of one: sums of
/// triangles at the border are no longer known.
void forgetBorder(const Triangulation& mesh, std::span<PostSum> sums);

/// One a vertex: a half-edge that leaves it; -1 on the border, or where none does.
std::vector<std::int32_t> innerStarts(const Triangulation& mesh);

}  // namespace trimtab::terrain
