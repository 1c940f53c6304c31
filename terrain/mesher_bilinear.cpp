#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <vector>

#include "trimtab/terrain/mesher.h"
#include "trimtab/terrain/mesher_scan.h"

namespace trimtab::terrain {

namespace {

/// Largest distance from the bilinear surface along one edge of a mesh.
///
/// Between crossings with rows and columns of posts the surface is a parabola along the edge, so its ends and
/// its turning point are all that counts.
class EdgeWalk {
 public:
  explicit EdgeWalk(const HeightField& field) : field_(field) {}

  double operator()(PolygonMesher::Point a, float za, PolygonMesher::Point b, float zb) {
    const double dx = static_cast<double>(b.column) - a.column, dy = static_cast<double>(b.row) - a.row;
    const auto nx = static_cast<std::uint32_t>(std::fabs(dx)), ny = static_cast<std::uint32_t>(std::fabs(dy));
    double worst = 0, before = 0, errorBefore = 0;
    std::uint32_t i = 1, j = 1;
    bool first = true;
    while (true) {
      // i and j: the next column and row that are crossed; compared as fractions, so that a post is one stop.
      double t;
      if (first) {
        t = 0;
      } else {
        if (i > nx && j > ny) break;
        const std::uint64_t left = std::uint64_t{i} * ny, right = std::uint64_t{j} * nx;
        const bool column = ny == 0 || (nx != 0 && left <= right),
                   row = nx == 0 || (ny != 0 && right <= left);
        t = column ? static_cast<double>(i) / nx : static_cast<double>(j) / ny;
        if (column) ++i;
        if (row) ++j;
      }
      const double error = signedError(a, dx, dy, za, zb, t);
      worst = std::max(worst, std::fabs(error));
      if (!first) {
        const double middle = signedError(a, dx, dy, za, zb, before + (t - before) / 2);
        // e(s) over [0, 1] is q s^2 + l s + errorBefore.
        const double q = 2 * (error + errorBefore - 2 * middle), l = error - errorBefore - q;
        if (q != 0) {
          const double s = -l / (2 * q);
          if (s > 0 && s < 1) worst = std::max(worst, std::fabs(errorBefore + s * (l + s * q)));
        }
      }
      before = t;
      errorBefore = error;
      first = false;
    }
    return worst;
  }

 private:
  double signedError(PolygonMesher::Point a, double dx, double dy, float za, float zb, double t) const {
    const double x = a.column + dx * t, y = a.row + dy * t;
    const auto column = std::min(static_cast<std::uint32_t>(std::max(x, 0.0)), field_.columns - 2);
    const auto row = std::min(static_cast<std::uint32_t>(std::max(y, 0.0)), field_.rows - 2);
    const double u = x - column, v = y - row;
    const float* const z = field_.z + row * field_.stride + column;
    const float* const up = z + field_.stride;
    const double low = z[0] + u * (static_cast<double>(z[1]) - z[0]);
    const double high = up[0] + u * (static_cast<double>(up[1]) - up[0]);
    return low + v * (high - low) - (za + t * (static_cast<double>(zb) - za));
  }
  const HeightField& field_;
};

/// Calls `edge` once for each edge of the triangles.
template <class Edge>
void eachEdge(std::span<const std::uint32_t> indices, std::size_t vertices, const Edge& edge) {
  // Half-edges that go up, by their lower vertex; those that go down are another's twin or on the border.
  std::vector<std::uint32_t> start(vertices + 1, 0);
  const auto each = [&](const auto& visit) {
    for (std::size_t i = 0; i < indices.size(); i += 3)
      for (std::size_t k = 0; k < 3; ++k) visit(indices[i + k], indices[k == 2 ? i : i + k + 1]);
  };
  each([&](std::uint32_t a, std::uint32_t b) {
    if (a < b) ++start[a + 1];
  });
  for (std::size_t v = 0; v < vertices; ++v) start[v + 1] += start[v];
  std::vector<std::uint32_t> to(start[vertices]), used(start.begin(), start.end() - 1);
  each([&](std::uint32_t a, std::uint32_t b) {
    if (a < b) {
      to[used[a]++] = b;
      edge(a, b);
    }
  });
  each([&](std::uint32_t a, std::uint32_t b) {
    if (a > b && std::find(&to[0] + start[b], &to[0] + start[b + 1], a) == &to[0] + start[b + 1]) edge(a, b);
  });
}

}  // namespace

double bilinearError(const HeightField& field, std::span<const PolygonMesher::Point> vertices,
                     std::span<const float> z, std::span<const std::uint32_t> indices) {
  assert(field.step == 1);
  double worst = 0;
  EdgeWalk walk(field);
  eachEdge(indices, vertices.size(), [&](std::uint32_t a, std::uint32_t b) {
    worst = std::max(worst, walk(vertices[a], z[a], vertices[b], z[b]));
  });
  // Inside a triangle the surface less the plane is a saddle in each cell: greatest at posts or on edges.
  constexpr bool kBorder[3] = {false, false, false};
  for (std::size_t i = 0; i < indices.size(); i += 3) {
    Triangulation::Vertex at[3];
    const Triangulation::Vertex* corner[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const PolygonMesher::Point& p = vertices[indices[i + k]];
      at[k] = {static_cast<std::int32_t>(p.column), static_cast<std::int32_t>(p.row), z[indices[i + k]]};
      corner[k] = &at[k];
    }
    if (Triangulation::turn(at[0], at[1], at[2].x, at[2].y) == 0) continue;
    forEachRow(corner, kBorder, 1, [&](const FacetRow& r) {
      const float* const posts = field.z + static_cast<std::size_t>(r.y) * field.stride;
      double facet = r.z;
      for (std::int32_t x = r.first; x <= r.last; ++x) {
        worst = std::max(worst, std::fabs(posts[x] - facet));
        facet += r.slope;
      }
    });
  }
  return worst;
}

}  // namespace trimtab::terrain
