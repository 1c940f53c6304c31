#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "core/terrain/static_lod/quadric.h"
#include "quad.h"
#include "table.h"

namespace trimtab::stress {
namespace {

using terrain::Quadric;

struct Plane {
  Vec3 normal, point;
  double weight;
};

struct Mesh {
  const char* name;
  std::vector<Plane> planes;
  Vec3 from, to;  ///< the edge that collapses
  double reach;   ///< no point is farther from the origin
};

/// Planes of triangles around an edge: flat, collinear (no area), slivers, landscape, cliffs.
Mesh randomMesh(std::mt19937_64& random, std::size_t kind, double scale, Vec3 place) {
  std::uniform_real_distribution<double> unit(-1, 1);
  static constexpr const char* kNames[] = {"flat", "collinear", "slivers", "landscape", "any planes"};
  Mesh mesh{kNames[kind], {}, {}, {}, 0};
  const auto point = [&](double x, double y, double z) {
    const Vec3 p = place + Vec3{x, y, z} * scale;
    mesh.reach = std::max(mesh.reach, length(p));
    return p;
  };
  const double heights[] = {0, 0, 1e-4, 0.1, 1};
  const auto height = [&] { return heights[kind] * unit(random); };
  mesh.from = point(-0.5 + 0.1 * unit(random), 0, height());
  mesh.to = point(0.5, 0.1 * unit(random), height());
  // A fan of four triangles around either end.
  for (int i = 0; i < 8; ++i) {
    const Vec3 corner = i % 2 == 0 ? mesh.from : mesh.to;
    const auto rim = [&] {
      if (kind == 1) return mesh.from + (mesh.to - mesh.from) * (2 * unit(random));
      return point(unit(random), kind == 2 ? 1e-7 * unit(random) : unit(random), height());
    };
    const Vec3 b = rim(), c = rim(), normal = cross(b - corner, c - corner);
    const double area = 0.5 * length(normal);
    if (area > 0) mesh.planes.push_back({normal * (0.5 / area), corner, area});
  }
  return mesh;
}

Quad sumTwin(const Mesh& mesh, Quad3 at) {
  Quad sum = 0;
  for (const Plane& p : mesh.planes) {
    const Quad d = dot(quad(p.normal), at - quad(p.point));
    sum += p.weight * d * d;
  }
  return sum;
}

/// Where the sum of a mesh is least, from its planes in exact arithmetic.
Quad3 leastTwin(const Mesh& mesh, Vec3 near) {
  Quad3 row[3] = {}, right{};
  for (const Plane& p : mesh.planes) {
    const Quad3 n = quad(p.normal), w = n * p.weight;
    row[0] = row[0] + n * w.x, row[1] = row[1] + n * w.y, row[2] = row[2] + n * w.z;
    right = right + w * dot(n, quad(p.point) - quad(near));
  }
  const Quad3 c = cross(row[1], row[2]);
  const Quad k = 1 / dot(row[0], c);
  return quad(near) + (c * right.x + cross(row[2], row[0]) * right.y + cross(row[0], row[1]) * right.z) * k;
}

bool isFinite(Vec3 v) {
  return std::isfinite(v.x + v.y + v.z);
}

TEST(QuadricStress, theErrorIsTheSumOfSquaredDistancesOnAnyMesh) {
  std::mt19937_64 random(61);
  std::uniform_real_distribution<double> unit(-1, 1);
  // Sums of products of weight x length^2, of which twenty are rounded for each of eight planes.
  Case error("quadrics", "error at the edge's ends and middle, of weight x farthest^2", 64 * kU, "",
             "it is a difference of terms of that size: ten coefficients of 4 roundings, 8 sums, 12 in its "
             "evaluation");
  Case positive("quadrics", "error below 0 or no number", 0, "violations",
                "held at 0, whatever rounding leaves");
  Case symmetric("quadrics", "sum of two quadrics in either order", 0, "differences",
                 "sums of two doubles commute to the bit");
  Case best("quadrics", "least place: worse than the better end, of weight x farthest^2", 2 * 64 * kU, "",
            "the better end may be taken for the worse by the error of either");
  Case above(
      "quadrics", "least place: above the exact least, of weight x farthest^2", std::pow(16e9 * kU, 2), "",
      "a determinant of 1e-9 and more magnifies 16 roundings of the place; the error grows with its square");
  Case between("quadrics", "place on the edge: worse than the better end, of weight x farthest^2",
               2 * 64 * kU, "", "the same");
  Case finite("quadrics", "places that are no number or off the edge", 0, "violations",
              "flat, collinear and sliver meshes have no least place, or one by the edge");
  for (std::size_t i = 0; i < samples(100000); ++i) {
    const std::size_t kind = i % 5;
    const double scale = std::pow(10, 3 * unit(random)) * (i % 3 == 0 ? 1e6 : 1);
    const Vec3 place =
        i % 2 == 0 ? Vec3{} : Vec3{1e5 * unit(random), 1e5 * unit(random), 3000 * unit(random)};
    const Mesh mesh = randomMesh(random, kind, scale, place);
    const auto where = [&] {
      return std::string(mesh.name) + " of scale " + digits(scale) + " at " + digits(length(place));
    };
    Quadric a, b;
    for (std::size_t k = 0; k < mesh.planes.size(); ++k) {
      const Plane& p = mesh.planes[k];
      (k % 2 == 0 ? a : b) += Quadric::plane(p.normal, p.point, p.weight);
    }
    const Quadric q = a + b, other = b + a;
    symmetric.require(q.xx == other.xx && q.xy == other.xy && q.xz == other.xz && q.yy == other.yy &&
                      q.yz == other.yz && q.zz == other.zz && q.bx == other.bx && q.by == other.by &&
                      q.bz == other.bz && q.c == other.c);
    Quad weight = 0;
    for (const Plane& p : mesh.planes) weight += p.weight;
    const Quad size = weight > 0 ? weight * mesh.reach * mesh.reach : Quad{1};
    const Vec3 middle = 0.5 * (mesh.from + mesh.to);
    for (const Vec3 at : {mesh.from, mesh.to, middle}) {
      error.see(toDouble(fabsq(q.at(at) - sumTwin(mesh, quad(at))) / size), where);
      positive.require(q.at(at) >= 0, where);
    }
    const Quad ends = std::min(sumTwin(mesh, quad(mesh.from)), sumTwin(mesh, quad(mesh.to)));
    const Vec3 on = q.leastBetween(mesh.from, mesh.to);
    finite.require(
        isFinite(on) && length(on - middle) <= 0.5 * length(mesh.to - mesh.from) + 4 * kU * mesh.reach,
        where);
    between.see(toDouble((sumTwin(mesh, quad(on)) - ends) / size), where);
    const auto least = q.least(middle);
    if (!least) continue;
    finite.require(isFinite(*least), where);
    // As the builder does: farther off than the edge is long, it is not taken.
    if (length(*least - middle) > length(mesh.to - mesh.from)) continue;
    best.see(toDouble((sumTwin(mesh, quad(*least)) - ends) / size), where);
    above.see(toDouble((sumTwin(mesh, quad(*least)) - sumTwin(mesh, leastTwin(mesh, middle))) / size), where);
  }
}

}  // namespace
}  // namespace trimtab::stress
