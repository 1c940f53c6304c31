#pragma once

#include "trimtab/terrain/mesher_lanes.h"
#include "trimtab/terrain/mesher_tiles.h"
#include "trimtab/terrain/mesher_triangulation.h"

namespace trimtab::terrain {

struct PostErrors {
  double max = 0, rms = 0;
};
/// Of a mesh that covers a field of step 1, in places of the field, at every post.
PostErrors postErrors(const Triangulation& mesh, const HeightField& field, unsigned threads);

/// Flips edges and moves heights of vertices where that makes the sum of squared errors smaller, and no post
/// worse than `bound` (where one is already, no worse than the worst about it). Vertices of the field's own
/// border stay.
Triangulation fitTiles(MeshTiles& tiles, const HeightField& field, double bound, unsigned threads);

/// The same for a mesh, on one thread; posts from place (0, 0) of the mesh.
class MeshFit {
 public:
  MeshFit(Triangulation& mesh, const PostRows& posts) : mesh_(mesh), posts_(posts) {}
  /// `sweeps` of flips, then heights. Vertices on the border are not moved. `known`: one a triangle, where
  /// they are known already.
  void run(double bound, int sweeps, std::vector<PostSum> known);

 private:
  PostSum sumOf(const Triangulation::Vertex& a, const Triangulation::Vertex& b,
                const Triangulation::Vertex& c, const bool border[3]) const;
  PostSum sumOf(std::int32_t t) const;
  void flipEdges(double bound);
  bool tryFlip(std::int32_t t, int i, double bound);
  void moveVertices(double bound);
  void moveVertex(std::uint32_t v, double bound);

  /// Sums over them, and of what moving the vertex sideways does to them.
  struct Star {
    double rr = 0, wr = 0, ww = 0, worst = 0;
    double xx = 0, xy = 0, yy = 0, xz = 0, yz = 0, rx = 0, ry = 0;
    std::int64_t area = 0;
    std::size_t posts = 0;  ///< lanes in about_
  };
  bool gather(std::int32_t start, const Triangulation::Vertex& at, Star& star);
  bool bestHeight(const Star& star, float was, double limit, float& z, double& squares) const;
  bool keeps(const Star& star, double rise, double limit) const;

  Triangulation& mesh_;
  PostRows posts_;
  std::vector<PostSum> sums_;                  ///< one a triangle
  std::vector<std::uint8_t> changed_, moved_;  ///< since edges were last tried; one a triangle, one a vertex
  /// Residuals r at the posts about a vertex change by -w d where it rises by d; w is its share. Four of the
  /// one, then four of the other; both are 0 where there is no post.
  std::vector<double> about_;
  std::vector<std::int32_t> starts_;  ///< a half-edge that leaves a vertex; -1: on the border
};

}  // namespace trimtab::terrain
