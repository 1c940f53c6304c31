#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/scene/objects/light_drawer.h"
#include "core/scene/objects/object_layer.h"
#include "core/scene/passes/scene_programs.h"
#include "core/scene/terrain/terrain_drawer.h"
#include "trimtab/culling/select_objects.h"
#include "trimtab/frame/object_frame.h"

namespace trimtab::scene {

/// Draws what stands on the ground, in any form of the terrain: selects it, keeps the selection while nothing
/// that it depends on changes, and draws it after the ground.
class ObjectDrawer {
 public:
  /// Starts with the objects of another terrain. If there is a context, it must be current.
  void setTerrain(const std::shared_ptr<const terrain::Database>& database);
  void initialize();
  void release() {
    layer_.reset();
    lights_.release();
  }

  /// Selects what the frame draws and uploads it. `hidden` must be of this frame: one flag per cell, not 0 if
  /// it is hidden; or nothing.
  void prepare(const FrameInProgress& frame, std::span<const std::uint8_t> hidden);
  /// Returns whether the last prepared frame draws any object or light.
  bool drawsAny() const { return (layer_ && !shown().drawn.empty()) || lights_.drawsAny(); }
  /// Draws them, with depths tested against what is there. As wires it draws no lights.
  void draw(ScenePrograms& programs, bool wire);
  /// Draws the same into an image of numbers: each pixel gets the number of its instance in the index.
  /// Lights have none.
  void drawNumbers(ScenePrograms& programs);
  /// Returns what the last prepared frame draws.
  ObjectFrame frame() const;

 private:
  /// Everything that a selection depends on.
  struct Key {
    EyePose eye;
    ViewShape view;
    CullingCase cullingCase = CullingCase::none;
    CutRule rule;
    double leastPx = 0, farM = 0, airM = 0;
    // What is uploaded depends on these too.
    Vec3 seenFrom;
    bool byReason = false, byLevel = false;
    friend bool operator==(const Key&, const Key&) = default;
  };
  const VisibleObjects& shown() const { return key_ && key_->byReason ? all_ : visible_; }
  std::vector<std::uint32_t> tintsOf(const VisibleObjects& shown) const;
  void drawWith(ScenePrograms& programs, SceneShaders plain, bool wire);

  std::shared_ptr<const terrain::ObjectTerrain> objects_;
  std::optional<Key> key_;
  std::vector<std::uint8_t> hidden_;  ///< the flags that the selection depends on
  VisibleObjects visible_;
  VisibleObjects all_;  ///< also what is culled, if reasons are shown
  std::unique_ptr<ObjectLayer> layer_;
  LightDrawer lights_;
};

}  // namespace trimtab::scene
