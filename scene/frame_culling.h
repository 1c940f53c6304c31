#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "trimtab/culling/select.h"
#include "trimtab/scene/horizon_culling.h"
#include "trimtab/scene/occlusion.h"
#include "trimtab/scene/occlusion_conditions.h"
#include "trimtab/scene/renderer.h"
#include "trimtab/scene/scene_graph.h"
#include "trimtab/terrain/database.h"

namespace trimtab::scene {

/// Depths (near / distance, row 0 at the bottom) as the greys that people look at.
Renderer::Grey greyOf(std::span<const float> depths, int width, int height, double nearM);

/// What a frame does to find the terrain's tiles that it draws: level cut, frustum, and horizon or depth map.
/// Keeps what can be kept from frame to frame; needs no context, except where OcclusionPass and TileCache are
/// passed.
class FrameCulling {
 public:
  void setDatabase(std::shared_ptr<const terrain::Database> database);
  /// Of the context's rasteriser.
  void setSubpixelBits(int bits) { subpixelBits_ = bits; }

  // In this order, every frame.
  /// The cut for an eye, only if it can have changed, which counts as `cutsSelected`.
  void selectCut(const FrameRequest& request, const EyePose& eye, FrameResult& counters);
  /// What the horizon hides, where that serves: false where it does not. Built only if it can have changed,
  /// which counts as `horizonsBuilt`, and not while it is believed to hide nothing: `horizonsLeftOut`.
  bool findHidden(const FrameRequest& request, FrameResult& counters);
  /// What of the cut is in the view and not hidden.
  void selectVisible(const FrameRequest& request);
  /// After the visible tiles have slots: whether there is a depth map in this frame, and its view. Else
  /// `counters.note` may say why not.
  std::optional<DepthView> prepareOcclusion(const FrameRequest& request, const TileCache& tiles,
                                            OcclusionPass& pass, FrameResult& counters);
  /// Tests the visible tiles against the depth map and takes out what it hides.
  void removeHidden(const TileCache& tiles, OcclusionPass& pass);
  /// Whether the eye is over the ground and above it, so that no underside can be seen; as of `selectCut`.
  bool eyeIsAboveGround() const { return refusal_.empty(); }

  const LevelCut& cut() const { return cut_; }
  const VisibleSet& visible() const { return visible_; }
  /// What may hide others in this frame.
  const std::vector<TileDraw>& occluders() const { return occluders_; }
  void plant(const Defects& defects) { defects_ = defects; }
  /// That served in the last frame, or null.
  const Horizon* horizon() const { return horizonServed_ ? &horizon_.horizon() : nullptr; }
  /// The last frame's depth map, if it drew one; else a picture of the last horizon, if that served.
  Renderer::Grey readDepthMap(const OcclusionPass& pass) const;

 private:
  /// What the level cut depends on.
  struct CutKey {
    Vec3 eye;
    double maxErrorPx = 0, lodScale = 0, pixelsPerRadian = 0;
    friend bool operator==(const CutKey&, const CutKey&) = default;
  };

  std::shared_ptr<const terrain::Database> database_;
  OcclusionConditions conditions_;
  HorizonCulling horizon_;
  int subpixelBits_ = 4;
  ViewShape view_;  ///< of the last frame that the horizon served, and the size that its band asked for
  DepthMapSize mapSize_;
  std::span<const std::uint8_t> hidden_;  ///< by the horizon, one a tile of the cut; or empty
  std::optional<CutKey> cutKey_;
  HorizonCulling::CutNumber cutNumber_;
  LevelCut cut_;
  VisibleSet visible_;
  EyePose eye_;
  std::string refusal_;  ///< why nothing may be hidden from the eye
  std::vector<std::uint32_t> testedSlots_;
  std::vector<TileDraw> occluders_;
  std::vector<std::uint8_t> flags_;
  Defects defects_;
  bool depthMapCurrent_ = false;  ///< the last frame drew one
  bool horizonServed_ = false;    ///< the last frame, if only by what was known nearby
  double nearM_ = 1;              ///< of the last depth map
};

}  // namespace trimtab::scene
