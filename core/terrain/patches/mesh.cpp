#include <algorithm>
#include <cmath>
#include <limits>

#include "page.h"
#include "trimtab/terrain/mesh/triangulation.h"

namespace trimtab::terrain {

namespace {

constexpr std::int64_t kStepsPerOrigin = 16 * PostGeometry::kStepsPerMetre;

/// Orders the triangles of a coarser variant like those of the finer one with the same numbers, so that
/// neighbours stay together.
void addTriangles(const PatchDraft& draft, PatchMesh& mesh) {
  const std::size_t variants = draft.variants.size();
  for (std::size_t v = 0; v < PatchIndex::kMostVariants; ++v)
    mesh.firstIndex[v + 1] =
        mesh.firstIndex[v] +
        (v < variants ? static_cast<std::uint32_t>(draft.variants[v].triangles.size()) : 0);
  // There is room for one more, because every triangle is written whether it is kept or not: that needs no
  // branch, which could not be predicted.
  mesh.indices.resize(mesh.firstIndex[variants] + std::size_t{3});
  mesh.inherited.resize(mesh.firstIndex[variants - 1] / 3 + std::size_t{1});
  std::uint16_t* out = mesh.indices.data();
  Inherited* inheritance = mesh.inherited.data();
  for (std::size_t v = 0; v < variants; ++v) {
    const PatchDraft::Variant& variant = draft.variants[v];
    const std::size_t count = variant.triangles.size() / 3;
    const bool coarsest = v + 1 == variants;
    const Inherited* const inherited = draft.variants[coarsest ? v : v + 1].inherited.data();
    for (const std::int32_t h : draft.order) {
      const auto t = static_cast<std::size_t>(h >> 2);
      const std::size_t is = t < count, at = t * is;
      const std::uint32_t* const corner = &variant.triangles[3 * at];
      const int i = h & 3;
      out[0] = static_cast<std::uint16_t>(corner[i]);
      out[1] = static_cast<std::uint16_t>(corner[Triangulation::next(i)]);
      out[2] = static_cast<std::uint16_t>(corner[Triangulation::before(i)]);
      out += 3 * is;
      *inheritance = inherited[at];
      inheritance += coarsest ? 0 : is;
    }
  }
  mesh.indices.resize(mesh.firstIndex[variants]);
  mesh.inherited.resize(mesh.firstIndex[variants - 1] / 3);
}

}  // namespace

PatchMesh patchMesh(const PatchIndex& index, const PostGeometry& geometry, const PatchDraft& draft,
                    Box& bounds) {
  PatchMesh mesh;
  const std::uint32_t side = index.squareCells(draft.place.pair);
  mesh.firstColumn = draft.place.column * side;
  mesh.firstRow = draft.place.row * side;
  constexpr std::int64_t kFar = std::numeric_limits<std::int64_t>::max();
  PostGeometry::Lattice low{kFar, kFar, kFar}, high{-kFar, -kFar, -kFar};
  std::vector<PostGeometry::Lattice> places;
  places.reserve(draft.vertices.size());
  for (std::size_t i = 0; i < draft.vertices.size(); ++i) {
    const PatchPoint& p = draft.vertices[i];
    const PostGeometry::Lattice at = geometry.lattice(p.row, p.column, draft.heights[i]);
    low = {std::min(low.x, at.x), std::min(low.y, at.y), std::min(low.z, at.z)};
    high = {std::max(high.x, at.x), std::max(high.y, at.y), std::max(high.z, at.z)};
    places.push_back(at);
  }
  const auto middle = [](std::int64_t a, std::int64_t b) {
    return static_cast<std::int32_t>(
        std::llround(static_cast<double>(a + b) / 2 / static_cast<double>(kStepsPerOrigin)));
  };
  mesh.origin[0] = middle(low.x, high.x);
  mesh.origin[1] = middle(low.y, high.y);
  mesh.origin[2] = middle(low.z, high.z);
  mesh.vertices.reserve(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto metres = [](std::int64_t steps, std::int32_t origin) {
      return static_cast<float>(steps - origin * kStepsPerOrigin) /
             static_cast<float>(PostGeometry::kStepsPerMetre);
    };
    PatchVertex v{};
    v.x = metres(places[i].x, mesh.origin[0]);
    v.y = metres(places[i].y, mesh.origin[1]);
    v.z = metres(places[i].z, mesh.origin[2]);
    v.column = static_cast<std::uint16_t>(draft.vertices[i].column - mesh.firstColumn);
    v.row = static_cast<std::uint16_t>(draft.vertices[i].row - mesh.firstRow);
    mesh.vertices.push_back(v);
  }
  addTriangles(draft, mesh);
  // The box is rounded outwards, because a float may not hold a place that far from the frame's origin.
  const auto metres = [](std::int64_t steps) {
    return static_cast<float>(static_cast<double>(steps) / PostGeometry::kStepsPerMetre);
  };
  constexpr float kMost = std::numeric_limits<float>::max();
  const auto below = [&](std::int64_t steps) { return std::nextafter(metres(steps), -kMost); };
  const auto above = [&](std::int64_t steps) { return std::nextafter(metres(steps), kMost); };
  bounds = {below(low.x), below(low.y), below(low.z), above(high.x), above(high.y), above(high.z)};
  return mesh;
}

NormalCone patchCone(const PatchDraft& draft, const PatchMesh& mesh) {
  std::vector<Vec3> normals;
  normals.reserve(2 * draft.variants[0].triangles.size() / 3);
  for (std::size_t v = 0; v < draft.variants.size(); ++v)
    draft.eachNew(v, [&](std::size_t, const std::uint32_t* corners) {
      const auto place = [&](std::size_t corner) {
        const PatchVertex& at = mesh.vertices[corners[corner]];
        return Vec3{at.x, at.y, at.z};
      };
      const Vec3 a = place(0), normal = cross(place(1) - a, place(2) - a);
      // A triangle without an area draws nothing.
      if (const double area = dot(normal, normal); area != 0)
        normals.push_back(normal * (1 / std::sqrt(area)));
    });
  return NormalCone::of(normals);
}

}  // namespace trimtab::terrain
