#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/scene/passes/scene_programs.h"
#include "core/scene/terrain/terrain_drawer.h"
#include "trimtab/culling/select_lights.h"
#include "trimtab/terrain/format/object_terrain.h"

namespace trimtab::scene {

/// Draws the lights of a terrain as discs of FrameRequest::lightPx pixels of the image. At size 0 it does
/// nothing: lights are uploaded, once, by the first frame that shows any.
class LightDrawer {
 public:
  LightDrawer();
  ~LightDrawer();

  /// Starts with the lights of another terrain; null for none. If there is a context, it must be current.
  void setTerrain(std::shared_ptr<const terrain::ObjectTerrain> objects);
  /// Needs the context current.
  void release();

  /// Selects what the frame draws; returns false if the selection of the frame before still holds. The
  /// context must be current.
  bool prepare(const FrameInProgress& frame);
  /// Returns whether the last prepared frame draws any light.
  bool drawsAny() const { return !cells_.empty(); }
  /// Draws them, with depths tested against what is there: one call for each cell.
  void draw(ScenePrograms& programs);

 private:
  class Points;

  std::shared_ptr<const terrain::ObjectTerrain> objects_;
  LightQuery query_;  ///< of `cells_`
  std::vector<std::uint32_t> cells_;
  Vec3 seenFrom_;
  std::unique_ptr<Points> points_;  ///< on the GPU
};

}  // namespace trimtab::scene
