#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/scene/scene_graph.h"
#include "core/scene/terrain/tiles/tile_ground.h"
#include "occlusion.h"
#include "occlusion_stage.h"
#include "trimtab/culling/select.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/scene/planted_defects.h"
#include "trimtab/scene/renderer.h"
#include "trimtab/terrain/format/database.h"

namespace trimtab::scene {

/// Returns depths (near / distance, row 0 at the bottom) as an image: the nearer, the darker; white without
/// ground.
Renderer::Grey greyOf(std::span<const float> depths, int width, int height, double nearM);

/// Finds the square tiles that a frame draws: the LOD cut, the view frustum, and the search for hidden
/// ground. Keeps its results while they stay valid. Needs a GL context only in the calls that get an
/// OcclusionPass.
class FrameCulling {
 public:
  /// Starts with another terrain.
  void setDatabase(std::shared_ptr<const terrain::Database> database);
  OcclusionStage& occlusion() { return occlusion_; }
  const OcclusionStage& occlusion() const { return occlusion_; }

  // Call these in this order in every frame.
  /// Selects the cut for an eye if anything that it depends on has changed.
  void selectCut(const FrameRequest& request, const EyePose& eye);
  /// Runs OcclusionStage::begin.
  void beginOcclusion(const FrameRequest& request);
  /// Selects what of the cut is in view and not hidden by the horizon. Returns false if the last visible set
  /// is kept.
  bool selectVisible(const FrameRequest& request);
  /// Removes from a newly selected visible set what the processor's map hides.
  void removeHiddenByMap(const FrameRequest& request);
  /// Returns the view of the depth map that the GPU must draw in this frame; unset if it draws none, and then
  /// `result().note` may say why. The visible tiles must have slots in `tiles`.
  std::optional<DepthView> prepareOcclusion(const FrameRequest& request, const TileCache& tiles,
                                            OcclusionPass& pass);
  /// Return what this frame's calls have found so far, and how much work they did.
  OcclusionResult result() const;
  FrameCounters counters() const;
  /// Tests the visible tiles against that map, waits for the result, and removes what it hides.
  void removeHidden(const TileCache& tiles, OcclusionPass& pass);

  const LevelCut& cut() const { return cut_; }
  const VisibleSet& visible() const { return visible_; }
  /// Returns the tiles to be drawn into the GPU's depth map.
  const std::vector<TileDraw>& occluders() const { return occluders_; }
  void plant(const Defects& defects);
  /// Returns the GPU's depth map of the last frame as an image, or else OcclusionStage::picture.
  Renderer::Grey readDepthMap(const OcclusionPass& pass) const;

 private:
  /// Everything that the LOD cut depends on.
  struct CutKey {
    Vec3 eye;
    double maxErrorPx = 0, lodScale = 0, pixelsPerRadian = 0;
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
  bool depthMapCurrent_ = false;  ///< the GPU draws a depth map in this frame
  double nearM_ = 1;              ///< of the last depth map
};

}  // namespace trimtab::scene
