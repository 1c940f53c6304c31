#pragma once

#include <map>
#include <vector>

#include "placed_instances.h"
#include "trimtab/terrain/format/object_terrain.h"
#include "trimtab/terrain/objects/build_model.h"
#include "trimtab/units/result.h"

namespace trimtab::terrain {

/// Puts models into the arrays of a terrain, one after the other.
class ModelPacker {
 public:
  explicit ModelPacker(ObjectTerrain& objects) : objects_(objects) {}

  /// Adds a model; returns how far it reaches. Fails if the arrays outgrow 32-bit numbers.
  Result<ModelExtent> add(const BuiltModel& model);
  /// How many different textures found no room.
  std::size_t texturesLeftOut() const { return leftOut_; }

 private:
  /// Returns the number of a texture, which may be that of an equal one; kNoTexture if there is no room.
  std::uint8_t numberOf(const ObjectTexture& texture);
  ObjectVertex packed(const SourceVertex& vertex, const std::vector<std::uint8_t>& numbers,
                      const BuiltModel& model, std::array<float, 2> shift) const;

  ObjectTerrain& objects_;
  std::multimap<std::uint64_t, std::uint8_t> known_;  ///< numbers by the checksum of their pixels
  std::size_t leftOut_ = 0;
};

}  // namespace trimtab::terrain
