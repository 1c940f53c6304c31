#include "packed_models.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "textures.h"
#include "trimtab/terrain/format/object_file.h"
#include "trimtab/terrain/format/store.h"

namespace trimtab::terrain {

std::uint8_t ModelPacker::numberOf(const ObjectTexture& texture) {
  const std::uint64_t sum =
      checksum({reinterpret_cast<const char*>(texture.pixels.data()), texture.pixels.size()});
  for (auto [at, end] = known_.equal_range(sum); at != end; ++at)
    if (objects_.textures[at->second].pixels == texture.pixels) return at->second;
  if (objects_.textures.size() >= ObjectLimits::kTextures) {
    ++leftOut_;
    return ObjectVertex::kNoTexture;
  }
  const auto number = static_cast<std::uint8_t>(objects_.textures.size());
  objects_.textures.push_back(texture);
  known_.emplace(sum, number);
  return number;
}

ObjectVertex ModelPacker::packed(const SourceVertex& vertex, const std::vector<std::uint8_t>& numbers,
                                 const BuiltModel& model, std::array<float, 2> shift) const {
  ObjectVertex v;
  v.x = vertex.position[0];
  v.y = vertex.position[1];
  v.z = vertex.position[2];
  for (std::size_t i = 0; i < 3; ++i)
    v.normal[i] = static_cast<std::int8_t>(std::lround(std::clamp(vertex.normal[i], -1.0f, 1.0f) * 127));
  v.colour = vertex.colour;
  if (vertex.texture == SourceVertex::kNoTexture) return v;
  v.texture = numbers[vertex.texture];
  if (v.texture == ObjectVertex::kNoTexture) {
    v.colour = product(v.colour, meanColour(model.textures[vertex.texture]));
    return v;
  }
  constexpr float kMostTurns = 2048;  // beyond it half floats do not tell whole turns apart
  for (std::size_t i = 0; i < 2; ++i)
    v.place[i] = meshopt_quantizeHalf(std::clamp(vertex.place[i] - shift[i], -kMostTurns, kMostTurns));
  return v;
}

Result<ModelExtent> ModelPacker::add(const BuiltModel& model) {
  constexpr std::size_t kMost = std::numeric_limits<std::uint32_t>::max();
  ObjectIndex& index = objects_.index;
  std::vector<std::uint8_t> numbers;
  for (const ObjectTexture& texture : model.textures) numbers.push_back(numberOf(texture));
  const auto first = model.levels[0].mesh.vertices[0].position;
  const Vec3 corner{first[0], first[1], first[2]};
  ModelExtent extent{corner, corner, 0, model.levels.back().errorM};
  ObjectIndex::Model made{static_cast<std::uint32_t>(index.levels.size()),
                          static_cast<std::uint32_t>(model.levels.size()), 0};
  for (const BuiltLevel& level : model.levels) {
    const SourceMesh& mesh = level.mesh;
    if (objects_.vertices.size() + mesh.vertices.size() > kMost ||
        objects_.indices.size() + mesh.indices.size() > kMost)
      return Finding{Severity::error, model.name, "", "at most 2^32 indices in all models together", "more"};
    objects_.meshes.push_back({static_cast<std::uint32_t>(objects_.vertices.size()),
                               static_cast<std::uint32_t>(objects_.indices.size()),
                               static_cast<std::uint32_t>(mesh.indices.size()), mesh.bothSides ? 1u : 0u});
    index.levels.push_back({level.errorM, static_cast<std::uint32_t>(mesh.triangles()),
                            static_cast<std::uint32_t>(mesh.vertices.size())});
    // Places begin near 0, where half floats are finest. They repeat, so whole turns make no difference.
    std::array<float, 2> shift{std::numeric_limits<float>::max(), std::numeric_limits<float>::max()};
    for (const SourceVertex& v : mesh.vertices)
      if (v.texture != SourceVertex::kNoTexture)
        for (std::size_t i = 0; i < 2; ++i) shift[i] = std::min(shift[i], std::floor(v.place[i]));
    for (const SourceVertex& v : mesh.vertices) {
      objects_.vertices.push_back(packed(v, numbers, model, shift));
      const double x = v.position[0], y = v.position[1], z = v.position[2];
      extent.low = {std::min(extent.low.x, x), std::min(extent.low.y, y), std::min(extent.low.z, z)};
      extent.high = {std::max(extent.high.x, x), std::max(extent.high.y, y), std::max(extent.high.z, z)};
      extent.radiusM = std::max(extent.radiusM, std::sqrt(x * x + y * y + z * z));
    }
    objects_.indices.insert(objects_.indices.end(), mesh.indices.begin(), mesh.indices.end());
  }
  // Rounded up twice: the square root was rounded as well.
  made.radiusM = std::nextafter(static_cast<float>(extent.radiusM), std::numeric_limits<float>::infinity());
  made.radiusM =
      std::min(std::nextafter(made.radiusM, std::numeric_limits<float>::infinity()), ObjectLimits::kRadiusM);
  extent.radiusM = made.radiusM;
  index.models.push_back(made);
  objects_.names.push_back(model.name);
  return extent;
}

}  // namespace trimtab::terrain
