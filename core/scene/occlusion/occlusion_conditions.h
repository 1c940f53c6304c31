#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/scene/surface/tile_indices.h"
#include "trimtab/culling/select.h"
#include "trimtab/scene/data_extent.h"
#include "trimtab/terrain/format/database.h"

namespace trimtab::scene {

/// Checks whether the proof of occlusion (resources/docs/occlusion.md) holds for an eye, and which tiles may
/// hide others.
class OcclusionConditions {
 public:
  void setDatabase(std::shared_ptr<const terrain::Database> database);

  /// Returns a sentence that says why nothing may be hidden from this eye, or an empty string if tiles may
  /// be. Builds the tile under the eye if that has changed.
  std::string refusal(const LevelCut& cut, const EyePose& eye, const ViewShape& view);
  /// Returns false near the data's edge, because a ray to such a tile might leave the terrain on its way.
  bool mayOcclude(std::uint32_t node) const { return mayOcclude_[node] != 0; }

 private:
  struct Ground {
    std::uint32_t node;
    double height;  ///< z of the drawn surface, metres, local frame
  };
  std::optional<Ground> groundUnder(const LevelCut& cut, Vec3 eye);

  std::shared_ptr<const terrain::Database> database_;
  std::vector<std::uint8_t> mayOcclude_;
  TileIndices indices_ = makeTileIndices();
  terrain::TileMesh mesh_;
  std::uint32_t meshNode_ = TerrainIndex::kNone;
  DataExtent extent_;
};

}  // namespace trimtab::scene
