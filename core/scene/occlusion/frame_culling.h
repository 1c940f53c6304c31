#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/scene/scene_graph.h"
#include "core/scene/terrain/cut_rule.h"
#include "core/scene/terrain/tiles/tile_ground.h"
#include "occlusion.h"
#include "occlusion_stage.h"
#include "trimtab/culling/select.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/scene/distance_image.h"
#include "trimtab/scene/planted_defects.h"
#include "trimtab/terrain/format/database.h"

namespace trimtab::scene {

/// What a frame does to find the terrain's tiles that it draws: level cut, frustum, and what looks for hidden
/// ground. Keeps what can be kept from frame to frame; needs no context, except where OcclusionPass and
/// TileCache are passed.
class FrameCulling {
 public:
  void setDatabase(std::shared_ptr<const terrain::Database> database);
  OcclusionStage& occlusion() { return occlusion_; }
  const OcclusionStage& occlusion() const { return occlusion_; }

  // In this order, every frame.
  /// The cut for an eye, only if it can have changed, which counts as `cutsSelected`.
  void selectCut(const FrameRequest& request, const EyePose& eye);
  /// What serves, and what the horizon hides.
  void beginOcclusion(const FrameRequest& request);
  /// What of the cut is in the view and not hidden: false where it is what it was in the last frame.
  bool selectVisible(const FrameRequest& request);
  /// Takes out of a new visible set what the processor's map hides.
  void removeHiddenByMap(const FrameRequest& request);
  /// After the visible tiles have slots: whether the GPU draws a depth map in this frame, and its view. Else
  /// `result().note` may say why not.
  std::optional<DepthView> prepareOcclusion(const FrameRequest& request, const TileCache& tiles,
                                            OcclusionPass& pass);
  /// What this frame's calls found so far, and how much work they did.
  OcclusionResult result() const;
  FrameCounters counters() const;
  /// Tests the visible tiles against that map and takes out what it hides.
  void removeHidden(const TileCache& tiles, OcclusionPass& pass);

  const LevelCut& cut() const { return cut_; }
  const VisibleSet& visible() const { return visible_; }
  /// What may hide others in this frame.
  const std::vector<TileDraw>& occluders() const { return occluders_; }
  void plant(const Defects& defects);
  /// The last frame's depth map, if one was drawn; else a picture of the last horizon, if that served.
  DistanceImage readDepthMap(const OcclusionPass& pass) const;

 private:
  /// What the level cut depends on.
  struct CutKey {
    Vec3 eye;
    CutRule rule;
    friend bool operator==(const CutKey&, const CutKey&) = default;
  };

  std::shared_ptr<const terrain::Database> database_;
  TileGround ground_;
  OcclusionStage occlusion_{ground_};
  std::optional<CutKey> cutKey_;
  bool cutSelected_ = false;  ///< in this frame
  std::string mapNote_;       ///< why the GPU draws no depth map
  CutNumber cutNumber_;
  LevelCut cut_;
  VisibleSet visible_;
  EyePose eye_;
  std::vector<std::uint32_t> testedSlots_;
  std::vector<TileDraw> occluders_;
  std::vector<std::uint8_t> flags_;
  Defects defects_;
  bool depthMapCurrent_ = false;  ///< the last frame drew one
  double nearM_ = 1;              ///< of the last depth map
};

}  // namespace trimtab::scene
