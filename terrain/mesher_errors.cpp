#include <algorithm>
#include <cmath>
#include <numeric>

#include "trimtab/terrain/mesher_errors.h"
#include "trimtab/terrain/mesher_lanes.h"

namespace trimtab::terrain {

namespace {

/// At the posts of a triangle: what is below rounding is none.
PostSum sumOf(const Triangulation& mesh, const PostRows& posts, const Triangulation::Triangle& one) {
  const Triangulation::Vertex* const corner[3] = {
      &mesh.vertices[one.corner[0]], &mesh.vertices[one.corner[1]], &mesh.vertices[one.corner[2]]};
  const bool border[3] = {one.twin[0] < 0, one.twin[1] < 0, one.twin[2] < 0};
  Lanes squares{}, worst{};
  forEachFour(
      corner, border, posts,
      [&](const Lanes& off, const Lanes(&)[3], std::int32_t, std::int32_t) __attribute__((always_inline)) {
        Lanes size;
        absoluteLanes(off, size);
        worst = size > worst ? size : worst;
        squares += off * off;
      });
  double scale = mostOfLanes(worst);
  for (const Triangulation::Vertex* v : corner) scale = std::max(scale, std::fabs(static_cast<double>(v->z)));
  return {sumOfLanes(squares), roundedError(mostOfLanes(worst), scale)};
}

}  // namespace

PostErrors postErrors(const Triangulation& mesh, const HeightField& field, std::span<const PostSum> sums) {
  const PostRows posts{field.z, field.stride, static_cast<std::int32_t>(field.columns)};
  PostSum all;
  const auto add = [&](double off) {
    all.squares += off * off;
    all.worst = std::max(all.worst, std::fabs(off));
  };
  for (const Triangulation::Vertex& v : mesh.vertices) add(posts.row(v.y)[v.x] - static_cast<double>(v.z));
  for (std::size_t v = 0; v < mesh.borderEdge.size(); ++v) {
    const std::int32_t h = mesh.borderEdge[v];
    if (h < 0) continue;
    const Triangulation::Vertex& a = mesh.vertices[v];
    const Triangulation::Triangle& one = mesh.triangles[static_cast<std::size_t>(h >> 2)];
    const Triangulation::Vertex& b = mesh.vertices[one.corner[Triangulation::next(h & 3)]];
    const std::int32_t steps = std::gcd(b.x - a.x, b.y - a.y);
    for (std::int32_t i = 1; i < steps; ++i) {
      const Triangulation::Vertex at{a.x + (b.x - a.x) / steps * i, a.y + (b.y - a.y) / steps * i, 0};
      const double facet = a.z + (static_cast<double>(b.z) - a.z) * i / steps;
      const double height = posts.row(at.y)[at.x], off = std::fabs(height - facet);
      add(roundedError(off, std::max({std::fabs(height), std::fabs(facet)})));
    }
  }
  for (std::size_t t = 0; t < sums.size(); ++t) {
    PostSum sum = sums[t];
    if (!sum.known() || sum.worst > all.worst) sum = sumOf(mesh, posts, mesh.triangles[t]);
    all.squares += sum.squares;
    all.worst = std::max(all.worst, sum.worst);
  }
  return {all.worst, std::sqrt(all.squares / (static_cast<double>(field.columns) * field.rows))};
}

}  // namespace trimtab::terrain
