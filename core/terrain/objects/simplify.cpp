#include "simplify.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "checked_mesh.h"
#include "textures.h"

namespace trimtab::terrain {

namespace {

/// Welds vertices that differ in normal and colour alone, which become the means of the corners'.
SourceMesh weldedSmoothly(const SourceMesh& mesh) {
  std::vector<SourceVertex> keys = mesh.vertices;
  for (SourceVertex& key : keys) {
    key.normal = {};
    key.colour = {};
  }
  std::vector<unsigned> remap(keys.size());
  const std::size_t count = meshopt_generateVertexRemap(
      remap.data(), mesh.indices.data(), mesh.indices.size(), keys.data(), keys.size(), sizeof(SourceVertex));
  SourceMesh out{std::vector<SourceVertex>(count), std::vector<std::uint32_t>(mesh.indices.size()),
                 mesh.bothSides};
  meshopt_remapVertexBuffer(out.vertices.data(), keys.data(), keys.size(), sizeof(SourceVertex),
                            remap.data());
  meshopt_remapIndexBuffer(out.indices.data(), mesh.indices.data(), mesh.indices.size(), remap.data());
  struct Sum {
    std::array<double, 3> normal{};
    std::array<double, 4> colour{};
    double corners = 0;
  };
  std::vector<Sum> sums(count);
  for (std::size_t k = 0; k < mesh.indices.size(); ++k) {
    const SourceVertex& corner = mesh.vertices[mesh.indices[k]];
    Sum& sum = sums[out.indices[k]];
    for (std::size_t i = 0; i < 3; ++i) sum.normal[i] += double{corner.normal[i]};
    for (std::size_t i = 0; i < 4; ++i) sum.colour[i] += corner.colour[i];
    sum.corners += 1;
  }
  for (std::size_t v = 0; v < count; ++v) {
    const auto& [normal, colour, corners] = sums[v];
    const double length = std::hypot(normal[0], normal[1], normal[2]);
    // Both sides of a leaf cancel out: it is lit from above.
    for (std::size_t i = 0; i < 3; ++i)
      out.vertices[v].normal[i] = length > 1e-6 ? static_cast<float>(normal[i] / length) : i == 2 ? 1.0f : 0;
    for (std::size_t i = 0; i < 4; ++i)
      out.vertices[v].colour[i] = static_cast<std::uint8_t>(std::lround(colour[i] / corners));
  }
  return out;
}

/// Gives each vertex the mean colour of its texture in its place, so that borders of textures do not hinder.
SourceMesh withoutTexture(SourceMesh mesh, const std::vector<std::array<std::uint8_t, 4>>& textures) {
  for (SourceVertex& v : mesh.vertices) {
    if (v.texture == SourceVertex::kNoTexture) continue;
    v.colour = product(v.colour, textures[v.texture]);
    v.texture = SourceVertex::kNoTexture;
    v.place = {};
  }
  return mesh;
}

/// Collapses edges; or, `loosely`, joins whatever vertices are near each other, touching or not.
SourceMesh simplifiedTo(const SourceMesh& mesh, std::size_t triangles, bool loosely) {
  SourceMesh out = mesh;
  constexpr float kAnyError = std::numeric_limits<float>::max();
  constexpr std::size_t kStride = sizeof(SourceVertex);
  const std::uint32_t* const from = mesh.indices.data();
  const float* const positions = mesh.vertices[0].position.data();
  const std::size_t indices = mesh.indices.size(), vertices = mesh.vertices.size(), most = 3 * triangles;
  const std::size_t count = loosely ? meshopt_simplifySloppy(out.indices.data(), from, indices, positions,
                                                             vertices, kStride, most, kAnyError, nullptr)
                                    : meshopt_simplify(out.indices.data(), from, indices, positions, vertices,
                                                       kStride, most, kAnyError, 0, nullptr);
  out.indices.resize(count);
  MeshFaults folded;  // a triangle that became a line is of no use
  return checkedMesh(out, std::numeric_limits<std::uint32_t>::max(), folded);
}

}  // namespace

std::vector<SourceMesh> simplified(const SourceMesh& mesh,
                                   const std::vector<std::array<std::uint8_t, 4>>& textures) {
  // Each hinders less than the one before: seams of normals, then seams of textures.
  const std::vector<SourceMesh> forms{mesh, weldedSmoothly(mesh),
                                      weldedSmoothly(withoutTexture(mesh, textures))};
  constexpr std::size_t kLeastTriangles = 4, kMostLoosely = 1000;
  constexpr double kNearEnough = 1.25;
  std::vector<SourceMesh> levels;
  for (std::size_t target = mesh.triangles() / 2; target >= kLeastTriangles; target /= 2) {
    SourceMesh best;
    for (const SourceMesh& form : forms) {
      SourceMesh level = simplifiedTo(form, target, false);
      if (level.triangles() > 0 && (best.triangles() == 0 || level.triangles() < best.triangles()))
        best = std::move(level);
      if (best.triangles() > 0 &&
          static_cast<double>(best.triangles()) <= kNearEnough * static_cast<double>(target))
        break;
    }
    if (best.triangles() > 0) levels.push_back(std::move(best));
    // Collapses lose leaves and other loose parts one by one; this keeps the outline of all of them.
    if (target <= kMostLoosely)
      if (SourceMesh level = simplifiedTo(mesh, target, true); level.triangles() > 0)
        levels.push_back(std::move(level));
  }
  return levels;
}

}  // namespace trimtab::terrain
