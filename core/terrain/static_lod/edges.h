#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

namespace trimtab::terrain {

/// One side of a triangle.
struct EdgeUse {
  std::uint32_t low, high;  ///< vertices, low < high
  std::uint32_t triangle;
  bool forward;  ///< the triangle goes from low to high
};

/// Returns the sides of all triangles, sorted so that those of one edge are neighbours, by triangle.
inline std::vector<EdgeUse> sortedEdges(std::span<const std::array<std::uint32_t, 3>> triangles) {
  std::vector<EdgeUse> edges;
  edges.reserve(triangles.size() * 3);
  for (std::uint32_t t = 0; t < triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = triangles[t][k], b = triangles[t][(k + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), t, a < b});
    }
  std::sort(edges.begin(), edges.end(), [](const EdgeUse& a, const EdgeUse& b) {
    return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
  });
  return edges;
}

/// Calls `visit` once for each edge, with the sides that lie there.
template <class Visit>
void forEachEdge(std::span<const EdgeUse> sorted, const Visit& visit) {
  for (std::size_t i = 0, end; i < sorted.size(); i = end) {
    for (end = i;
         end < sorted.size() && sorted[end].low == sorted[i].low && sorted[end].high == sorted[i].high;)
      ++end;
    visit(sorted.subspan(i, end - i));
  }
}

}  // namespace trimtab::terrain
