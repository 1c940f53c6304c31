#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/scene/surface/surfaces_in_use.h"
#include "occlusion_conditions.h"
#include "trimtab/culling/depth_map.h"
#include "trimtab/culling/select.h"
#include "trimtab/scene/distance_image.h"
#include "trimtab/terrain/format/database.h"

namespace trimtab::scene {

/// The view that a depth map is drawn for.
struct MapView {
  ViewShape view;            ///< of the image
  OcclusionResolution size;  ///< of the map
  double lowering = 1;       ///< DepthMap::Settings::lowering
};

/// Fills `out` with what a depth map needs of a tile: its occluder (occluder.h) and the boxes of its parts as
/// drawn. `slopeMax` is the index's for the node.
void makeDepthMesh(const terrain::TileMesh& mesh, float slopeMax, DepthMesh& out);

/// Finds which of a set of meshes hide each other, with the CPU's depth map (culling/depth_map.h). Needs no
/// GL context.
class DepthMapCulling {
 public:
  struct Item {
    const DepthMesh* mesh = nullptr;  ///< if null, the item is never hidden and hides nothing
    const depth::Triangles* triangles = nullptr;
    bool mayOcclude = false;
  };
  /// Draws the items that may occlude, nearest first, and tests all of them. Returns a DepthFate per item,
  /// valid until the next call. OcclusionConditions must not refuse the eye.
  std::span<const std::uint8_t> hidden(std::span<const Item> items, const EyePose& eye, const MapView& view);
  /// Returns the last map as an image in greys.
  DistanceImage picture() const;

 private:
  DepthMap map_;
  double nearM_ = 1;
  std::vector<std::uint8_t> fates_;
  struct Place {
    float distance;
    std::uint32_t item;
  };
  std::vector<Place> places_;
};

/// The CPU's depth map over the tiles of a cut. Makes each tile's mesh when it is first needed and keeps it
/// while it is in use.
class MapCulling {
 public:
  /// Starts with another terrain, or with none if it is null.
  void setDatabase(std::shared_ptr<const terrain::Database> database);
  /// Tests the tiles of `visible`, which are those of the cut in view that are not known to be hidden.
  /// Returns one flag per tile, in their order, as removeOccluded reads them. `conditions` must not refuse
  /// the eye. Makes no more meshes than `share` allows; a tile without a mesh is kept.
  std::span<const std::uint8_t> hidden(const LevelCut& cut, std::span<const TileDraw> visible,
                                       const EyePose& eye, const MapView& view,
                                       const OcclusionConditions& conditions, SurfaceShare& share);
  /// Returns the last map as an image in greys.
  DistanceImage picture() const { return culling_.picture(); }

 private:
  void make(std::uint32_t node);

  std::shared_ptr<const terrain::Database> database_;
  SurfacesInUse<DepthMesh> meshes_;  ///< 8 KB each
  terrain::TileMesh mesh_;
  DepthMapCulling culling_;
  std::vector<DepthMapCulling::Item> items_;
};

}  // namespace trimtab::scene
