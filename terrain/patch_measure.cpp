#include <algorithm>
#include <cmath>
#include <limits>

#include "trimtab/terrain/patch_page.h"

namespace trimtab::terrain {

namespace {

constexpr std::int64_t kStepsPerOrigin = 16 * PostGeometry::kStepsPerMetre;

struct Sums {
  double worst = 0, squares = 0;
  std::uint64_t posts = 0;
};

}  // namespace

void measurePage(const PatchIndex& index, const PatchIndex::Page& page, const HeightSource& heights,
                 const PostGeometry& geometry, std::span<const PatchDraft> drafts, BuiltPage& built) {
  const PostWindow window = pageWindow(index, page);
  std::vector<float> z(window.size());
  heights.read(window, 1, z);
  const auto heightAt = [&](PatchPoint p) {
    return z[std::size_t{p.row - window.row} * window.columns + (p.column - window.column)];
  };
  const double sag = 0.1;
  for (const PatchDraft& draft : drafts) {
    PatchMesh mesh;
    PatchFacts facts;
    std::array<float, PatchIndex::kVariants> errors{};
    const std::uint32_t side = index.squareCells(page.pair);
    mesh.firstColumn = draft.place.column * side;
    mesh.firstRow = draft.place.row * side;
    std::vector<PostGeometry::Lattice> places;
    constexpr std::int64_t kFar = std::numeric_limits<std::int64_t>::max();
    PostGeometry::Lattice low{kFar, kFar, kFar}, high{-kFar, -kFar, -kFar};
    for (const PatchPoint& p : draft.vertices) {
      const PostGeometry::Lattice at = geometry.lattice(p.row, p.column, heightAt(p));
      low = {std::min(low.x, at.x), std::min(low.y, at.y), std::min(low.z, at.z)};
      high = {std::max(high.x, at.x), std::max(high.y, at.y), std::max(high.z, at.z)};
      places.push_back(at);
    }
    const auto origin = [](std::int64_t a, std::int64_t b) {
      return static_cast<std::int32_t>(
          std::llround(static_cast<double>(a + b) / 2 / static_cast<double>(kStepsPerOrigin)));
    };
    mesh.origin[0] = origin(low.x, high.x);
    mesh.origin[1] = origin(low.y, high.y);
    mesh.origin[2] = origin(low.z, high.z);
    for (std::size_t i = 0; i < places.size(); ++i) {
      const auto metres = [](std::int64_t steps, std::int32_t from) {
        return static_cast<float>(steps - from * kStepsPerOrigin) /
               static_cast<float>(PostGeometry::kStepsPerMetre);
      };
      PatchVertex v{};
      v.x = metres(places[i].x, mesh.origin[0]);
      v.y = metres(places[i].y, mesh.origin[1]);
      v.z = metres(places[i].z, mesh.origin[2]);
      const PatchPoint p = draft.vertices[i];
      v.column = static_cast<std::uint16_t>(p.column - mesh.firstColumn);
      v.row = static_cast<std::uint16_t>(p.row - mesh.firstRow);
      const auto slope = [&](PatchPoint a, PatchPoint b, double metresApart) {
        return metresApart > 0 ? (heightAt(b) - heightAt(a)) / metresApart : 0.0;
      };
      PatchPoint w = p, e = p, s = p, n = p;
      if (p.column > window.column) --w.column;
      if (p.column + 1 < window.column + window.columns) ++e.column;
      if (p.row > window.row) --s.row;
      if (p.row + 1 < window.row + window.rows) ++n.row;
      const Vec3 normal =
          geometry.normal(p.row, p.column, slope(w, e, geometry.columnM(p.row) * (e.column - w.column)),
                          slope(s, n, geometry.rowM(p.row) * (n.row - s.row)));
      v.normal[0] = static_cast<std::int8_t>(std::lround(normal.x * 127));
      v.normal[1] = static_cast<std::int8_t>(std::lround(normal.y * 127));
      v.normal[2] = static_cast<std::int8_t>(std::lround(normal.z * 127));
      mesh.vertices.push_back(v);
    }
    float lowest = std::numeric_limits<float>::max(), highest = -lowest;
    for (std::size_t variant = 0; variant < PatchIndex::kVariants; ++variant) {
      const auto& triangles = draft.triangles[variant];
      mesh.firstIndex[variant] = static_cast<std::uint32_t>(mesh.indices.size());
      mesh.indices.insert(mesh.indices.end(), triangles.begin(), triangles.end());
      Sums sums;
      for (std::size_t t = 0; t + 2 < triangles.size(); t += 3) {
        const PatchPoint a = draft.vertices[triangles[t]], b = draft.vertices[triangles[t + 1]],
                         c = draft.vertices[triangles[t + 2]];
        const auto signedArea = [](PatchPoint p, PatchPoint q, double x, double y) {
          return (double{1} * q.column - p.column) * (y - p.row) -
                 (double{1} * q.row - p.row) * (x - p.column);
        };
        const double area = signedArea(a, b, c.column, c.row);
        const auto [r0, r1] = std::minmax({a.row, b.row, c.row});
        const auto [c0, c1] = std::minmax({a.column, b.column, c.column});
        for (std::uint32_t r = r0; r <= r1; ++r)
          for (std::uint32_t k = c0; k <= c1; ++k) {
            const double u = signedArea(b, c, k, r), v = signedArea(c, a, k, r), w = signedArea(a, b, k, r);
            if (u < 0 || v < 0 || w < 0) continue;
            const float h = heightAt({k, r});
            const double error = std::abs((u * heightAt(a) + v * heightAt(b) + w * heightAt(c)) / area - h);
            sums.worst = std::max(sums.worst, error);
            sums.squares += error * error;
            ++sums.posts;
            lowest = std::min(lowest, h);
            highest = std::max(highest, h);
          }
      }
      errors[variant] = static_cast<float>(sums.worst + sag);
      facts.rmsErrorM[variant] =
          static_cast<float>(std::sqrt(sums.squares / static_cast<double>(sums.posts)));
      facts.bilinearErrorM[variant] = errors[variant];
      facts.posts = static_cast<std::uint32_t>(sums.posts);
    }
    mesh.firstIndex[PatchIndex::kVariants] = static_cast<std::uint32_t>(mesh.indices.size());
    facts.lowestM = lowest;
    facts.highestM = highest;
    facts.vertices = static_cast<std::uint32_t>(mesh.vertices.size());
    facts.bytes =
        static_cast<std::uint32_t>(mesh.vertices.size() * sizeof(PatchVertex) + mesh.indices.size() * 2);
    const auto below = [](std::int64_t steps) {
      return std::nextafter(static_cast<float>(static_cast<double>(steps) / PostGeometry::kStepsPerMetre),
                            -std::numeric_limits<float>::max());
    };
    const auto above = [](std::int64_t steps) {
      return std::nextafter(static_cast<float>(static_cast<double>(steps) / PostGeometry::kStepsPerMetre),
                            std::numeric_limits<float>::max());
    };
    built.bounds.push_back(
        {below(low.x), below(low.y), below(low.z), above(high.x), above(high.y), above(high.z)});
    built.errorM.push_back(errors);
    built.facts.push_back(facts);
    built.meshes.patches.push_back(std::move(mesh));
  }
}

}  // namespace trimtab::terrain
