#include "trimtab/culling/mesh_relief.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "trimtab/frame/box_union.h"

namespace trimtab {
namespace {

using Triangle = std::array<std::uint16_t, 3>;

/// Interleaves the bits of both numbers (Morton order), so that what is near in both is near in the result.
std::uint32_t interleaved(std::uint32_t a, std::uint32_t b) {
  const auto spread = [](std::uint32_t v) {
    v = (v | v << 8) & 0x00ff00ffu;
    v = (v | v << 4) & 0x0f0f0f0fu;
    v = (v | v << 2) & 0x33333333u;
    return (v | v << 1) & 0x55555555u;
  };
  return spread(a & 0xffffu) | spread(b & 0xffffu) << 1;
}

/// Updates `steepest` and `upright` by one triangle, in doubles made from the floats that are drawn.
void judge(const ReliefVertex& a, const ReliefVertex& b, const ReliefVertex& c, MeshRelief& relief) {
  const double ux = double{b.x} - a.x, uy = double{b.y} - a.y, uz = double{b.z} - a.z;
  const double vx = double{c.x} - a.x, vy = double{c.y} - a.y, vz = double{c.z} - a.z;
  const double up = ux * vy - uy * vx;
  const double flat = std::hypot(uy * vz - uz * vy, uz * vx - ux * vz);
  if (!(up > 0 && flat < MeshRelief::kSteepest * up)) relief.upright = false;
  relief.steepest = std::max(relief.steepest, static_cast<float>(up > 0 ? flat / up : 1e6));
}

void addParts(std::span<const ReliefVertex> vertices, std::vector<Triangle>& triangles, MeshRelief& relief) {
  std::uint16_t firstColumn = 0xffff, firstRow = 0xffff;
  for (const ReliefVertex& v : vertices) {
    firstColumn = std::min(firstColumn, v.column);
    firstRow = std::min(firstRow, v.row);
  }
  const auto place = [&](const Triangle& t) {
    std::uint32_t column = 0, row = 0;
    for (const std::uint16_t i : t) {
      column += static_cast<std::uint32_t>(vertices[i].column - firstColumn);
      row += static_cast<std::uint32_t>(vertices[i].row - firstRow);
    }
    return interleaved(column / 3, row / 3);
  };
  std::sort(triangles.begin(), triangles.end(), [&](const Triangle& a, const Triangle& b) {
    return std::pair(place(a), a) < std::pair(place(b), b);
  });

  std::vector<std::uint16_t> used;
  for (std::size_t first = 0; first < triangles.size(); first += MeshRelief::kPartTriangles) {
    const std::size_t end = std::min(first + MeshRelief::kPartTriangles, triangles.size());
    MeshRelief::Part part{.box = kNoBox,
                          .firstVertex = static_cast<std::uint32_t>(relief.x.size()),
                          .firstCorner = static_cast<std::uint32_t>(relief.corners.size()),
                          .triangles = static_cast<std::uint8_t>(end - first)};
    used.clear();
    for (std::size_t i = first; i < end; ++i)
      used.insert(used.end(), triangles[i].begin(), triangles[i].end());
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    part.vertices = static_cast<std::uint8_t>(used.size());
    for (std::size_t i = 0; i < used.size(); ++i) {
      const ReliefVertex& v = vertices[used[i]];
      relief.x.push_back(v.x);
      relief.y.push_back(v.y);
      relief.z.push_back(v.z);
      part.box = united(part.box, v.x, v.y, v.z);
      if (v.z > vertices[used[part.peak]].z) part.peak = static_cast<std::uint8_t>(i);
    }
    for (std::size_t i = first; i < end; ++i)
      for (const std::uint16_t corner : triangles[i])
        relief.corners.push_back(
            static_cast<std::uint8_t>(std::lower_bound(used.begin(), used.end(), corner) - used.begin()));
    relief.parts.push_back(part);
  }
}

/// A point where an edge meets a line of posts.
struct Crossing {
  std::uint32_t line;
  double along;  ///< columns along a row, rows along a column
  float x, y, z;
};

/// Appends the crossings of all edges with the rows (or columns) whose number `step` divides. An edge
/// includes its lower end but not its upper one, so a line through a vertex gets it from the edges above.
template <bool Rows>
void cross(std::span<const ReliefVertex> vertices, std::span<const Triangle> triangles, int step,
           std::vector<Crossing>& crossings) {
  const auto across = [](const ReliefVertex& v) { return static_cast<int>(Rows ? v.row : v.column); };
  const auto along = [](const ReliefVertex& v) { return static_cast<double>(Rows ? v.column : v.row); };
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const ReliefVertex *a = &vertices[t[k]], *b = &vertices[t[(k + 1) % 3]];
      // Both triangles of an edge start at the same end, so both compute the same bits.
      if (across(*a) > across(*b)) std::swap(a, b);
      const int low = across(*a), high = across(*b);
      for (int line = (low + step - 1) / step * step; line < high; line += step) {
        const double s = static_cast<double>(line - low) / (high - low);
        const auto between = [s](double from, double to) { return from + s * (to - from); };
        crossings.push_back({static_cast<std::uint32_t>(line), between(along(*a), along(*b)),
                             static_cast<float>(between(a->x, b->x)), static_cast<float>(between(a->y, b->y)),
                             static_cast<float>(between(a->z, b->z))});
      }
    }
}

/// Adds the lines. No edge lies between two successive crossings, so both are on one triangle. The mesh's
/// outline is convex, so a line meets it in one piece.
template <bool Rows>
void addLines(std::span<const ReliefVertex> vertices, std::span<const Triangle> triangles, int step,
              MeshRelief& relief) {
  std::vector<Crossing> crossings;
  cross<Rows>(vertices, triangles, step, crossings);
  const auto place = [](const Crossing& c) { return std::pair(c.line, c.along); };
  std::sort(crossings.begin(), crossings.end(),
            [&](const Crossing& a, const Crossing& b) { return place(a) < place(b); });
  crossings.erase(std::unique(crossings.begin(), crossings.end(),
                              [&](const Crossing& a, const Crossing& b) { return place(a) == place(b); }),
                  crossings.end());
  for (std::size_t first = 0, end = 0; first < crossings.size(); first = end) {
    while (end < crossings.size() && crossings[end].line == crossings[first].line) ++end;
    if (end - first < 2 || end - first > std::size_t{MeshRelief::kMostCorners}) continue;
    for (std::size_t i = first; i < end; ++i) {
      relief.lineX.push_back(crossings[i].x);
      relief.lineY.push_back(crossings[i].y);
      relief.lineZ.push_back(crossings[i].z);
    }
    const std::size_t from = relief.lineFirst.back();
    const std::span<const float> x = std::span(relief.lineX).subspan(from),
                                 y = std::span(relief.lineY).subspan(from),
                                 z = std::span(relief.lineZ).subspan(from);
    relief.besideM = std::max(relief.besideM, furthestBeside(x, y));
    Box box = kNoBox;
    for (std::size_t i = 0; i < x.size(); ++i) box = united(box, x[i], y[i], z[i]);
    relief.lineBox.push_back(box);
    relief.lineFirst.push_back(static_cast<std::uint32_t>(relief.lineX.size()));
  }
}

}  // namespace

void makeMeshRelief(std::span<const ReliefVertex> vertices, std::span<const std::uint16_t> indices,
                    Vec3 origin, int step, MeshRelief& relief) {
  relief = {};
  relief.origin = origin;
  relief.bounds = kNoBox;
  if (indices.size() < 3) return;
  float furthest = 0;
  relief.peak[2] = -std::numeric_limits<float>::max();
  std::vector<Triangle> triangles;
  triangles.reserve(indices.size() / 3);
  relief.upright = true;
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    triangles.push_back({indices[i], indices[i + 1], indices[i + 2]});
    judge(vertices[indices[i]], vertices[indices[i + 1]], vertices[indices[i + 2]], relief);
    for (std::size_t k = 0; k < 3; ++k) {
      const ReliefVertex& v = vertices[indices[i + k]];
      if (!(std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z))) {
        relief.upright = false;
        return;
      }
      relief.bounds = united(relief.bounds, v.x, v.y, v.z);
      furthest = std::max({furthest, std::abs(v.x), std::abs(v.y), std::abs(v.z)});
      if (v.z > relief.peak[2]) relief.peak = {v.x, v.y, v.z};
    }
  }
  relief.reach = furthest;
  addParts(vertices, triangles, relief);
  if (!relief.upright) return;
  addLines<true>(vertices, triangles, step, relief);
  addLines<false>(vertices, triangles, step, relief);
}

}  // namespace trimtab
