#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "horizon_memory.h"
#include "occlusion_ground.h"
#include "trimtab/culling/occlusion_choice.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/scene/distance_image.h"
#include "trimtab/scene/planted_defects.h"

namespace trimtab::scene {

/// The stage of a frame that looks for hidden ground: it decides which method is used, and runs the horizon.
/// It serves tiles and patches alike and keeps its results while they stay valid. Needs no GL context;
/// TileDrawer runs the published depth map.
///
/// The occlusion resolution is the size in texels that the band of the decision asks for. Presets, traces and
/// the papers call it the size of the depth map, but it sizes the horizon too: the horizon has two columns
/// per quarter of the circle for each texel of its width, within Horizon's limits.
class OcclusionStage {
 public:
  /// `ground` must outlive the stage.
  explicit OcclusionStage(OcclusionGround& ground) : ground_(ground) {}
  OcclusionStage(const OcclusionStage&) = delete;
  OcclusionStage& operator=(const OcclusionStage&) = delete;

  /// Discards everything, for another terrain.
  void clear();
  /// Sets the bits of a pixel that the rasteriser of a new context keeps of vertices. Costs are learnt again.
  void setSubpixelBits(int bits);
  /// Sets deliberate errors, for tests that see the proof fail.
  void plant(const Defects& defects);

  // Call these in this order in every frame; query only if visibleStays returned false.
  /// Decides which method is used and finds what the horizon hides. The ground must have the cut of this
  /// frame. `gpuDrawsMaps` says whether the caller can draw the published depth map; if not, the horizon
  /// replaces it.
  void begin(const FrameRequest& request, const EyePose& eye, bool gpuDrawsMaps);
  /// Returns one flag per tile of the cut, not 0 if the horizon proves it hidden; or nothing.
  std::span<const std::uint8_t> hidden() const { return hidden_; }
  /// Returns one flag per box of the ground, not 0 if the horizon proves it hidden; or nothing.
  std::span<const std::uint8_t> hiddenBoxes() const { return hiddenBoxes_; }
  /// Returns another number for each horizon that is used; 0 if none is.
  std::uint64_t horizonNumber() const { return hidden_.empty() ? 0 : memory_.number(); }
  /// Returns the query that selects what of the ground's cut is visible.
  VisibleQuery query(const FrameRequest& request);
  /// Returns true if the visible set of the last frame is still right. Otherwise the caller must select it
  /// again, which is counted.
  bool visibleStays(const FrameRequest& request);
  /// Return what this frame's calls have found so far, and how much work they did.
  const OcclusionResult& result() const { return result_; }
  const FrameCounters& counters() const { return counters_; }
  /// Learns from what the finished frame cost.
  void finished(const FrameResult& result);

  /// Reports whether this frame uses a method.
  bool serves(OcclusionMethod method) const { return serves_ == method; }
  /// Returns the occlusion resolution of the last frame that had a method.
  OcclusionResolution resolution() const { return resolution_; }
  /// Returns whether the eye is over the ground and above it, so that no underside can be seen.
  bool eyeIsAboveGround() const { return refusal_.empty(); }
  /// Returns the horizon that shaped the visible set of the last frame, or null.
  const Horizon* horizon() const { return hidden_.empty() ? nullptr : &memory_.horizon(); }
  /// Returns the horizon as an image; empty if none shaped the visible set.
  DistanceImage picture() const;

 private:
  std::optional<OcclusionMethod> choose(const FrameRequest& request);
  void findHorizon(const FrameRequest& request);

  /// Everything that the visible set depends on.
  struct VisibleKey {
    EyePose eye;
    ViewShape view;
    CullingCase method = CullingCase::none;
    bool backFaces = false;
    double farM = 0;
    CutNumber cut;
    std::optional<OcclusionMethod> serves;
    OcclusionResolution resolution;
    std::uint64_t horizon = 0;   ///< HorizonMemory::number; 0 without a horizon
    std::uint64_t surfaces = 0;  ///< made since the start
    friend bool operator==(const VisibleKey&, const VisibleKey&) = default;
  };

  OcclusionGround& ground_;
  OcclusionResult result_;
  FrameCounters counters_;
  HorizonMemory memory_;
  OcclusionChoice choice_;
  double drawingMs_ = 0;  ///< that all frames so far took
  bool chosen_ = false;   ///< choice_ chose the method of this frame
  int unlearnt_ = 0;      ///< successive frames that choice_ did not learn from
  Defects defects_;
  std::vector<std::uint8_t> planted_;  ///< hidden_ and the node that is culled by mistake
  int subpixelBits_ = 4;
  EyePose eye_;
  ViewShape view_;
  OcclusionResolution resolution_;
  std::string refusal_;  ///< why nothing may be hidden from the eye
  std::optional<OcclusionMethod> serves_;
  std::span<const std::uint8_t> hidden_, hiddenBoxes_;
  std::optional<VisibleKey> visibleKey_;
};

}  // namespace trimtab::scene
