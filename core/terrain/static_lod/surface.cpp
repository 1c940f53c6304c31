#include "surface.h"

#include <algorithm>
#include <cmath>

#include "edges.h"
#include "texture.h"

namespace trimtab::terrain {

namespace {

/// Fixes vertices whose triangles are no single closed fan, though each edge of theirs has two sides.
void fixTouchingFans(const LatticeTile& tile, std::vector<std::uint8_t>& fixed) {
  struct Link {
    std::uint32_t centre, from, to;
  };
  std::vector<Link> links;
  links.reserve(tile.triangles.size() * 3);
  for (const auto& t : tile.triangles)
    for (std::size_t k = 0; k < 3; ++k) links.push_back({t[k], t[(k + 1) % 3], t[(k + 2) % 3]});
  std::sort(links.begin(), links.end(), [](const Link& a, const Link& b) {
    return a.centre != b.centre ? a.centre < b.centre : a.from < b.from;
  });
  for (std::size_t i = 0, end; i < links.size(); i = end) {
    for (end = i; end < links.size() && links[end].centre == links[i].centre;) ++end;
    if (fixed[links[i].centre]) continue;
    std::size_t walked = 0;
    std::uint32_t at = links[i].from;
    do {
      const auto found = std::lower_bound(
          links.begin() + static_cast<std::ptrdiff_t>(i), links.begin() + static_cast<std::ptrdiff_t>(end),
          at, [](const Link& link, std::uint32_t from) { return link.from < from; });
      if (found == links.begin() + static_cast<std::ptrdiff_t>(end) || found->from != at) break;
      at = found->to;
      ++walked;
    } while (at != links[i].from && walked < end - i);
    if (walked != end - i || at != links[i].from) fixed[links[i].centre] = 1;
  }
}

}  // namespace

SourceSurface analyse(const LatticeTile& tile, const Lattice& origin, double boundaryWeight) {
  SourceSurface surface;
  surface.fixed.assign(tile.shared.begin(), tile.shared.end());
  surface.quadrics.resize(tile.vertices.size());
  const auto place = [&](std::uint32_t v) { return tile.vertices[v].metres() - origin.metres(); };

  for (const auto& t : tile.triangles) {
    if (orientation(tile.vertices[t[0]], tile.vertices[t[1]], tile.vertices[t[2]]) <= 0) {
      ++surface.folded;
      for (const std::uint32_t v : t) surface.fixed[v] = 1;
    }
    const Vec3 a = place(t[0]);
    const Vec3 n = cross(place(t[1]) - a, place(t[2]) - a);
    const double twice = length(n);
    if (!(twice > 0)) continue;
    const Quadric q = Quadric::plane(n * (1 / twice), a, twice / 6);
    for (const std::uint32_t v : t) surface.quadrics[v] += q;
  }

  forEachEdge(sortedEdges(tile.triangles), [&](std::span<const EdgeUse> edge) {
    const EdgeUse& e = edge[0];
    if (edge.size() != 2 || edge[1].forward == e.forward) {
      surface.fixed[e.low] = surface.fixed[e.high] = 1;
      return;
    }
    if (tile.material[e.triangle] == tile.material[edge[1].triangle] && !isSeam(tile, e, edge[1])) return;
    const Vec3 a = place(e.low), along = place(e.high) - a;
    const double flat = std::hypot(along.x, along.y);
    if (!(flat > 0)) return;
    const Quadric q =
        Quadric::plane({along.y / flat, -along.x / flat, 0}, a, boundaryWeight * 0.5 * dot(along, along));
    surface.quadrics[e.low] += q;
    surface.quadrics[e.high] += q;
  });
  addTextureQuadrics(tile, origin, boundaryWeight, surface.quadrics);
  fixTouchingFans(tile, surface.fixed);
  return surface;
}

}  // namespace trimtab::terrain
