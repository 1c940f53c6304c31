#pragma once

#include <cstdint>
#include <vector>

#include "fit.h"

namespace trimtab::terrain {

/// Takes vertices out of a mesh, about in the order in which the sum of squared errors grows. Greedy
/// insertion takes what is furthest off at the time, and with what came later some of it serves little.
class MeshThin {
 public:
  /// The sums of `fit`, which is of the same mesh, stay right; nothing else of it does.
  MeshThin(Triangulation& mesh, MeshFit& fit) : mesh_(mesh), fit_(fit), starts_(innerStarts(mesh)) {}
  /// Up to `most` that are not on the border, as long as no post gets further off than `bound`; how many.
  /// They stay in the mesh without triangles.
  std::size_t thin(std::size_t most, double bound);

 private:
  static constexpr std::size_t kMostAbout = 16;  ///< triangles; a vertex with more stays
  /// Of a vertex, whose triangles become a fan from a vertex of the ring about it.
  struct Removal {
    double cost = 0;  ///< growth of the sum: guessed, or `exact`
    std::uint32_t vertex = 0, stamp = 0, from = 0;
    std::uint32_t under = 0;  ///< which triangle of the fan, from 1 on, has the vertex's post
    bool exact = false;
    std::size_t sums = 0;  ///< where exact: of the fan's triangles, the first in known_
  };
  struct About {
    std::uint32_t vertex;
    std::int32_t outer, triangle;  ///< beyond the edge to the next; between it and the vertex in the middle
  };
  bool gatherRing(std::uint32_t v);
  /// Triangle k of a fan, from 1 on, has this and the next corner beside the one all start from.
  std::size_t along(std::size_t from, std::size_t k) const { return (from + k) % ring_.size(); }
  bool guess(std::uint32_t v, double bound, Removal& removal);
  bool measure(Removal& removal, double bound);
  void remove(const Removal& removal);
  void compact();

  Triangulation& mesh_;
  MeshFit& fit_;
  std::vector<std::int32_t> starts_;
  std::vector<std::uint32_t> stamps_;  ///< one a vertex: how often its ring has changed
  std::vector<About> ring_;            ///< anticlockwise
  std::vector<PostSum> known_;         ///< of fans that were measured
};

}  // namespace trimtab::terrain
