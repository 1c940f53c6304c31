#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/scene/terrain/surfaces_in_use.h"
#include "occlusion_conditions.h"
#include "trimtab/culling/depth_map.h"
#include "trimtab/culling/select.h"
#include "trimtab/scene/distance_image.h"
#include "trimtab/terrain/format/database.h"

namespace trimtab::scene {

/// What a depth map is drawn for.
struct MapView {
  ViewShape view;       ///< the picture's
  DepthMapSize size;    ///< the map's: as the band says
  double lowering = 1;  ///< of what the proof asks for: Defects
};

/// A tile for the depth map: its occluder, and boxes of its parts as drawn.
void makeDepthMesh(const terrain::TileMesh& mesh, float slopeMax, DepthMesh& out);

/// Meshes that may hide each other, nearest first, by the CPU's depth map. Needs no context.
class DepthMapCulling {
 public:
  struct Item {
    const DepthMesh* mesh = nullptr;  ///< null: never hidden, hides nothing
    const depth::Triangles* triangles = nullptr;
    bool mayOcclude = false;
  };
  /// One an item: a DepthFate. The eye must be one that may hide (OcclusionConditions).
  std::span<const std::uint8_t> hidden(std::span<const Item> items, const EyePose& eye, const MapView& view);
  DistanceImage picture() const;
  std::uint64_t drawn() const { return drawn_; }  ///< maps, since the start
  std::uint64_t triangles() const { return map_.triangles(); }

 private:
  DepthMap map_;
  double nearM_ = 1;
  std::vector<std::uint8_t> fates_;
  struct Place {
    float distance;
    std::uint32_t item;
  };
  std::vector<Place> places_;
  std::uint64_t drawn_ = 0;
};

/// Meshes of tiles for depth maps: made when they are first asked for, kept while they are in use.
class TileMeshes {
 public:
  void setDatabase(std::shared_ptr<const terrain::Database> database);
  const DepthMesh* find(std::uint32_t node) const { return meshes_.find(node); }  ///< null: not made
  /// Good until the next `forgetOthers`.
  const DepthMesh& of(std::uint32_t node);
  void forgetOthers(const LevelCut& cut) { meshes_.forgetOthers(cut); }
  const std::vector<Box>& bounds() const { return database_->index().bounds; }
  static const depth::Triangles& triangles();
  std::uint64_t made() const { return made_; }

 private:
  std::shared_ptr<const terrain::Database> database_;
  SurfacesInUse<DepthMesh> meshes_;  ///< 8 KB each
  std::uint64_t made_ = 0;
  terrain::TileMesh mesh_;
};

/// The CPU's depth map over the tiles of a cut.
class MapCulling {
 public:
  void setDatabase(std::shared_ptr<const terrain::Database> database);
  /// `visible`: those of the cut in view that are not known to be hidden. One each, in their order, as
  /// removeOccluded takes them. The eye must be one that `conditions` do not refuse.
  std::span<const std::uint8_t> hidden(const LevelCut& cut, std::span<const TileDraw> visible,
                                       const EyePose& eye, const MapView& view,
                                       const OcclusionConditions& conditions, SurfaceShare& share);
  /// The last map.
  DistanceImage picture() const { return culling_.picture(); }
  std::uint64_t drawn() const { return culling_.drawn(); }
  std::uint64_t triangles() const { return culling_.triangles(); }
  std::uint64_t meshesMade() const { return meshes_.made(); }

 private:
  TileMeshes meshes_;
  DepthMapCulling culling_;
  std::vector<DepthMapCulling::Item> items_;
};

}  // namespace trimtab::scene
