#include "checked_mesh.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>

#include "trimtab/units/linear.h"

namespace trimtab::terrain {

namespace {

bool isFinite(const std::array<float, 3>& v) {
  return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]);
}
double lengthOf(const std::array<float, 3>& v) {
  return std::hypot(double{v[0]}, double{v[1]}, double{v[2]});
}
Vec3 vectorOf(const std::array<float, 3>& v) {
  return {v[0], v[1], v[2]};
}

/// Returns the normal of a triangle, twice its area long.
Vec3 normalOf(const SourceVertex& a, const SourceVertex& b, const SourceVertex& c) {
  const Vec3 origin = vectorOf(a.position);
  return cross(vectorOf(b.position) - origin, vectorOf(c.position) - origin);
}

/// Makes a normal one of unit length; of one that is none, that of the face.
void checkNormal(SourceVertex& vertex, Vec3 face) {
  const bool usable = isFinite(vertex.normal) && lengthOf(vertex.normal) > 1e-6;
  const Vec3 unit = normalized(usable ? vectorOf(vertex.normal) : face);
  vertex.normal = {static_cast<float>(unit.x), static_cast<float>(unit.y), static_cast<float>(unit.z)};
}

}  // namespace

SourceMesh welded(const SourceMesh& mesh) {
  if (mesh.indices.empty()) return {{}, {}, mesh.bothSides};
  std::vector<unsigned> remap(mesh.vertices.size());
  const std::size_t count =
      meshopt_generateVertexRemap(remap.data(), mesh.indices.data(), mesh.indices.size(),
                                  mesh.vertices.data(), mesh.vertices.size(), sizeof(SourceVertex));
  SourceMesh out{std::vector<SourceVertex>(count), std::vector<std::uint32_t>(mesh.indices.size()),
                 mesh.bothSides};
  meshopt_remapVertexBuffer(out.vertices.data(), mesh.vertices.data(), mesh.vertices.size(),
                            sizeof(SourceVertex), remap.data());
  meshopt_remapIndexBuffer(out.indices.data(), mesh.indices.data(), mesh.indices.size(), remap.data());
  return out;
}

SourceMesh checkedMesh(const SourceMesh& mesh, std::size_t textures, MeshFaults& faults) {
  // The corners of each triangle apart: a corner without a normal takes that of each of its faces.
  SourceMesh corners{{}, {}, mesh.bothSides};
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const std::array<std::uint32_t, 3> at{mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]};
    if (std::any_of(at.begin(), at.end(), [&](std::uint32_t k) { return k >= mesh.vertices.size(); })) {
      ++faults.noCorner;
      continue;
    }
    std::array<SourceVertex, 3> t{mesh.vertices[at[0]], mesh.vertices[at[1]], mesh.vertices[at[2]]};
    if (std::any_of(t.begin(), t.end(), [](const SourceVertex& v) { return !isFinite(v.position); })) {
      ++faults.noNumber;
      continue;
    }
    const Vec3 face = normalOf(t[0], t[1], t[2]);
    if (!(length(face) > 0)) {
      ++faults.noArea;
      continue;
    }
    for (SourceVertex& v : t) {
      faults.farthestM = std::max(faults.farthestM, lengthOf(v.position));
      checkNormal(v, face);
      if (v.texture >= textures) v.texture = SourceVertex::kNoTexture;
      const bool placed = std::isfinite(v.place[0]) && std::isfinite(v.place[1]);
      if (v.texture != SourceVertex::kNoTexture && !placed) ++faults.noPlace;
      if (v.texture == SourceVertex::kNoTexture || !placed) v.place = {};
      corners.indices.push_back(static_cast<std::uint32_t>(corners.vertices.size()));
      corners.vertices.push_back(v);
    }
  }
  return welded(corners);
}

std::array<float, 3> faceNormal(const SourceMesh& mesh, std::size_t triangle) {
  const std::uint32_t* const i = &mesh.indices[3 * triangle];
  const Vec3 n = normalOf(mesh.vertices[i[0]], mesh.vertices[i[1]], mesh.vertices[i[2]]);
  return {static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z)};
}

}  // namespace trimtab::terrain
