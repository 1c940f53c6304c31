#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "trimtab/terrain/objects/build_model.h"

/// Models made of formulas, and distances by brute force.
namespace trimtab::test {

using Corner = std::array<float, 3>;

inline void addTriangle(terrain::SourceMesh& mesh, Corner a, Corner b, Corner c) {
  for (const Corner& p : {a, b, c}) {
    mesh.indices.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
    terrain::SourceVertex v;
    v.position = p;
    mesh.vertices.push_back(v);
  }
}

/// A lumpy ball of 2 * rings * rings triangles or so, standing on the ground, its corners not shared.
inline terrain::SourceMesh ball(int rings, float radius, float lumps) {
  terrain::SourceMesh mesh;
  const auto place = [&](int i, int j) -> Corner {
    const double a = std::numbers::pi * i / rings, b = std::numbers::pi * (j % (2 * rings)) / rings;
    const double r = radius * (1 + lumps * std::sin(5 * a) * std::sin(3 * b));
    return {static_cast<float>(r * std::sin(a) * std::cos(b)),
            static_cast<float>(r * std::sin(a) * std::sin(b)), static_cast<float>(r * std::cos(a) + radius)};
  };
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < 2 * rings; ++j) {
      if (i > 0) addTriangle(mesh, place(i, j), place(i + 1, j), place(i, j + 1));
      if (i + 1 < rings) addTriangle(mesh, place(i, j + 1), place(i + 1, j), place(i + 1, j + 1));
    }
  return mesh;
}

/// Leaves: triangles that touch nothing, in all directions.
inline terrain::SourceMesh leaves(int count, unsigned seed) {
  terrain::SourceMesh mesh;
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> wide(-3, 3), high(2, 9), leaf(-0.5f, 0.5f);
  for (int i = 0; i < count; ++i) {
    const Corner at{wide(random), wide(random), high(random)};
    const auto near = [&] {
      return Corner{at[0] + leaf(random), at[1] + leaf(random), at[2] + leaf(random)};
    };
    const Corner a = near(), b = near(), c = near();
    addTriangle(mesh, a, b, c);
  }
  return mesh;
}

inline Vec3 cornerOf(const terrain::SourceMesh& mesh, std::size_t k) {
  const Corner& p = mesh.vertices[mesh.indices[k]].position;
  return {double{p[0]}, double{p[1]}, double{p[2]}};
}

/// The distance of a point from a segment, and from a triangle: its face if the foot of the plumb line is
/// inside, else its nearest side.
inline double toSegment(Vec3 p, Vec3 a, Vec3 b) {
  const Vec3 ab = b - a;
  const double t = std::clamp(dot(p - a, ab) / std::max(dot(ab, ab), 1e-30), 0.0, 1.0);
  return length(p - a - ab * t);
}
inline double toTriangle(Vec3 p, Vec3 a, Vec3 b, Vec3 c) {
  const Vec3 n = normalized(cross(b - a, c - a));
  const Vec3 foot = p - n * dot(p - a, n);
  const bool inside = dot(cross(b - a, foot - a), n) >= 0 && dot(cross(c - b, foot - b), n) >= 0 &&
                      dot(cross(a - c, foot - c), n) >= 0;
  if (inside) return std::abs(dot(p - a, n));
  return std::min({toSegment(p, a, b), toSegment(p, b, c), toSegment(p, c, a)});
}
inline double toMesh(Vec3 p, const terrain::SourceMesh& mesh) {
  double nearest = 1e30;
  for (std::size_t k = 0; k < mesh.indices.size(); k += 3)
    nearest =
        std::min(nearest, toTriangle(p, cornerOf(mesh, k), cornerOf(mesh, k + 1), cornerOf(mesh, k + 2)));
  return nearest;
}

/// The farthest of random points and corners of `from` from `to`.
inline double farthestSampled(const terrain::SourceMesh& from, const terrain::SourceMesh& to,
                              int perTriangle) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  double farthest = 0;
  for (std::size_t k = 0; k < from.indices.size(); k += 3) {
    const Vec3 a = cornerOf(from, k), b = cornerOf(from, k + 1), c = cornerOf(from, k + 2);
    for (const Vec3& p : {a, b, c}) farthest = std::max(farthest, toMesh(p, to));
    for (int i = 0; i < perTriangle; ++i) {
      double s = unit(random), t = unit(random);
      if (s + t > 1) {
        s = 1 - s;
        t = 1 - t;
      }
      farthest = std::max(farthest, toMesh(a + (b - a) * s + (c - a) * t, to));
    }
  }
  return farthest;
}

inline terrain::SourceModel modelOf(std::string name, std::vector<terrain::SourceMesh> levels) {
  return {std::move(name), std::move(levels), {}};
}

}  // namespace trimtab::test
