#pragma once

#include <span>
#include <vector>

#include "trimtab/terrain/mesher_lanes.h"
#include "trimtab/terrain/mesher_tiles.h"
#include "trimtab/terrain/mesher_triangulation.h"

namespace trimtab::terrain {

/// Flips edges and moves vertices where that makes the sum of squared errors smaller, and no post worse than
/// `bound` (where one is already, no worse than the worst about it). Vertices of the field's own border stay.
/// The field has step 1, as in all of these.
Triangulation fitTiles(MeshTiles& tiles, const HeightField& field, double bound, unsigned threads);

/// Of a mesh that covers a field, in places of the field: one a triangle.
std::vector<PostSum> postSums(const Triangulation& mesh, const HeightField& field, unsigned threads);
/// Moves vertices by height about posts that are not well within `bound`, where those get nearer by it.
void mendPosts(Triangulation& mesh, const HeightField& field, double bound, std::vector<PostSum>& sums);

struct PostErrors {
  double max = 0, rms = 0;
};
/// At every post, from the sums of all triangles.
PostErrors postErrors(const Triangulation& mesh, const HeightField& field, std::span<const PostSum> sums);

/// The same for a mesh, on one thread; posts from place (0, 0) of the mesh.
class MeshFit {
 public:
  MeshFit(Triangulation& mesh, const PostRows& posts) : mesh_(mesh), posts_(posts) {}
  /// Flips edges where the sum of squares gets smaller for it. `known`: one a triangle, where they are known
  /// already.
  void flipEdges(double bound, int passes, std::vector<PostSum> known);
  /// Moves vertices that are not on the border, by height and by whole posts, for the same.
  void moveVertices(double bound);
  /// Moves vertices about posts that are further off than `bound` by height, a few times, as long as the
  /// furthest gets nearer. `sums`: one a triangle; stay right.
  void mendPosts(double bound, std::span<PostSum> sums);

 private:
  PostSum sumOf(const Triangulation::Vertex& a, const Triangulation::Vertex& b,
                const Triangulation::Vertex& c, const bool border[3]) const;
  PostSum sumOf(std::int32_t t) const;
  bool tryFlip(std::int32_t t, int i, double bound);
  void findStarts();
  void moveVertex(std::uint32_t v, double bound);
  bool mendVertex(std::uint32_t v, double bound);

  /// Sums over them, and of what moving the vertex sideways does to them.
  struct Star {
    double rr = 0, wr = 0, ww = 0, worst = 0;
    double xx = 0, xy = 0, yy = 0, xz = 0, yz = 0, rx = 0, ry = 0;
    std::int64_t area = 0;
    std::size_t posts = 0;  ///< lanes in about_
  };
  /// Whether the triangles about a vertex would stay anticlockwise with it there: only then there are posts.
  bool mayStand(std::int32_t start, const Triangulation::Vertex& there) const;
  void gather(std::int32_t start, const Triangulation::Vertex& at, Star& star);
  bool bestHeight(const Star& star, float was, double limit, float& z, double& squares) const;
  bool keeps(const Star& star, double rise, double limit) const;

  Triangulation& mesh_;
  PostRows posts_;
  std::vector<PostSum> sums_;          ///< one a triangle
  std::vector<std::uint8_t> changed_;  ///< one a triangle: since edges were last tried
  /// Residuals r at the posts about a vertex change by -w d where it rises by d; w is its share. Four of the
  /// one, then four of the other; both are 0 where there is no post.
  std::vector<double> about_;
  std::vector<std::int32_t> starts_;  ///< a half-edge that leaves a vertex; -1: on the border
};

}  // namespace trimtab::terrain
