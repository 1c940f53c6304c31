#include "app/models/canonical.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <numeric>
#include <utility>

namespace trimtab::models {

namespace {

using terrain::SourceMesh;
using terrain::SourceModel;
using terrain::SourceTexture;
using terrain::SourceVertex;

bool comesBefore(const SourceTexture& a, const SourceTexture& b) {
  if (a.width != b.width) return a.width < b.width;
  if (a.height != b.height) return a.height < b.height;
  return a.pixels < b.pixels;
}

void sortTextures(SourceModel& model) {
  std::vector<std::uint32_t> order(model.textures.size()), numbers(model.textures.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return comesBefore(model.textures[a], model.textures[b]);
  });
  std::vector<SourceTexture> sorted;
  for (std::uint32_t i = 0; i < order.size(); ++i) {
    numbers[order[i]] = i;
    sorted.push_back(std::move(model.textures[order[i]]));
  }
  model.textures = std::move(sorted);
  for (SourceMesh& mesh : model.levels)
    for (SourceVertex& v : mesh.vertices)
      if (v.texture < numbers.size()) v.texture = numbers[v.texture];
}

void sortTriangles(SourceMesh& mesh) {
  // A corner that is not there is named later on; it sorts as a vertex of its own.
  SourceVertex none;
  none.position.fill(std::numeric_limits<float>::quiet_NaN());
  const auto corner = [&](std::size_t k) -> const SourceVertex& {
    return mesh.indices[k] < mesh.vertices.size() ? mesh.vertices[mesh.indices[k]] : none;
  };
  std::vector<std::uint32_t> order(mesh.triangles());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    for (std::size_t k = 0; k < 3; ++k)
      if (const int differ = std::memcmp(&corner(3 * std::size_t{a} + k), &corner(3 * std::size_t{b} + k),
                                         sizeof(SourceVertex)))
        return differ < 0;
    return false;
  });
  SourceMesh sorted{{}, {}, mesh.bothSides};
  sorted.vertices.reserve(3 * order.size());
  for (const std::uint32_t t : order)
    for (std::size_t k = 3 * std::size_t{t}; k < 3 * std::size_t{t} + 3; ++k) {
      const bool there = mesh.indices[k] < mesh.vertices.size();
      sorted.indices.push_back(there ? static_cast<std::uint32_t>(sorted.vertices.size())
                                     : std::numeric_limits<std::uint32_t>::max());
      sorted.vertices.push_back(corner(k));
    }
  mesh = std::move(sorted);
}

}  // namespace

void makeCanonical(SourceModel& model) {
  sortTextures(model);
  for (SourceMesh& mesh : model.levels) sortTriangles(mesh);
}

}  // namespace trimtab::models
