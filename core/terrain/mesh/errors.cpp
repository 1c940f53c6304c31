#include "errors.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tiles.h"

namespace trimtab::terrain {

namespace {

/// Triangles that are summed up together: the same on any number of threads.
constexpr std::size_t kTogether = 4096;

/// At the posts of a triangle: what is below rounding is none.
PostSum sumOf(const Triangulation& mesh, const PostRows& posts, const Triangulation::Triangle& one) {
  const Triangulation::Vertex* const corner[3] = {
      &mesh.vertices[one.corner[0]], &mesh.vertices[one.corner[1]], &mesh.vertices[one.corner[2]]};
  const bool border[3] = {one.twin[0] < 0, one.twin[1] < 0, one.twin[2] < 0};
  PostSum sum = sumOfPosts(corner, border, posts);
  double scale = sum.worst;
  for (const Triangulation::Vertex* v : corner) scale = std::max(scale, std::fabs(static_cast<double>(v->z)));
  sum.worst = roundedError(sum.worst, scale);
  return sum;
}

}  // namespace

TRIMTAB_LANES PostSum sumOfPosts(const Triangulation::Vertex* const corner[3], const bool border[3],
                                 const PostRows& posts) {
  Lanes squares{}, worst{};
  forEachFour(
      corner, border, posts,
      [&](const Lanes& off, const Lanes(&)[3], std::int32_t, std::int32_t) __attribute__((always_inline)) {
        Lanes size;
        absoluteLanes(off, size);
        worst = size > worst ? size : worst;
        squares += off * off;
      });
  return {sumOfLanes(squares), mostOfLanes(worst)};
}

PostErrors postErrors(const Triangulation& mesh, const HeightField& field, std::span<const PostSum> sums,
                      unsigned threads) {
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
  std::vector<PostSum> parts((sums.size() + kTogether - 1) / kTogether, PostSum{0, all.worst});
  onThreads(threads, static_cast<std::uint32_t>(parts.size()), [&](std::uint32_t part) {
    PostSum own = parts[part];
    for (std::size_t t = part * kTogether; t < std::min(sums.size(), (part + 1) * kTogether); ++t) {
      PostSum sum = sums[t];
      if (!sum.known() || sum.worst > own.worst) sum = sumOf(mesh, posts, mesh.triangles[t]);
      own.squares += sum.squares;
      own.worst = std::max(own.worst, sum.worst);
    }
    parts[part] = own;
  });
  for (const PostSum& part : parts) {
    all.squares += part.squares;
    all.worst = std::max(all.worst, part.worst);
  }
  return {all.worst, std::sqrt(all.squares / (static_cast<double>(field.columns) * field.rows))};
}

}  // namespace trimtab::terrain
