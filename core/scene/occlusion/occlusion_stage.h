#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "horizon_memory.h"
#include "occlusion_ground.h"
#include "trimtab/culling/occlusion_choice.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/scene/distance_image.h"
#include "trimtab/scene/planted_defects.h"

namespace trimtab::scene {

/// What looks for hidden ground in a frame, and what of it the processor does: horizon and its own depth map.
/// The same for every form of the terrain. Keeps what can be kept from frame to frame. Needs no context.
class OcclusionStage {
 public:
  /// `ground` must live as long.
  explicit OcclusionStage(OcclusionGround& ground) : ground_(ground) {}
  OcclusionStage(const OcclusionStage&) = delete;
  OcclusionStage& operator=(const OcclusionStage&) = delete;

  /// Another terrain: everything is forgotten.
  void clear();
  /// Of the rasteriser of a new context: what frames cost is learnt anew.
  void setSubpixelBits(int bits);
  void plant(const Defects& defects);

  // In this order, every frame.
  /// After the cut: decides what serves, and finds what the horizon hides.
  void begin(const FrameRequest& request, const EyePose& eye, bool gpuDrawsMaps);
  /// One a tile of the cut, not 0 where the horizon proves it hidden; or empty.
  std::span<const std::uint8_t> hidden() const { return hidden_; }
  /// Whether the visible set of the last frame is this one's too, maps included; else it must be chosen anew,
  /// which is counted.
  bool visibleStays(const FrameRequest& request);
  /// What of `visible`, which was chosen anew, the processor's map hides, as removeOccluded takes it; or
  /// empty.
  std::span<const std::uint8_t> hiddenByMap(const FrameRequest& request, const VisibleSet& visible);
  /// What this frame's calls found so far, and how much work they did.
  const OcclusionResult& result() const { return result_; }
  const FrameCounters& counters() const { return counters_; }
  /// The frame is finished: what it cost is learnt from.
  void finished(const FrameResult& result);

  /// What serves in this frame; none: nothing looks for hidden ground.
  std::optional<OcclusionMethod> serves() const { return serves_; }
  bool serves(OcclusionMethod method) const { return serves_ == method; }
  bool horizonServes() const {
    return serves(OcclusionMethod::horizon) || serves(OcclusionMethod::horizon_and_map);
  }
  bool mapServes() const {
    return serves(OcclusionMethod::cpu_map) || serves(OcclusionMethod::horizon_and_map);
  }
  /// The size that the band asks for, where something serves.
  DepthMapSize size() const { return size_; }
  /// Whether the eye is over the ground and above it, so that no underside can be seen.
  bool eyeIsAboveGround() const { return refusal_.empty(); }
  /// That had a part in the visible set of the last frame, or null.
  const Horizon* horizon() const { return hidden_.empty() ? nullptr : &memory_.horizon(); }
  /// What the processor's map saw, or else the horizon; empty where neither had a part in the visible set.
  DistanceImage picture() const;

 private:
  std::optional<OcclusionMethod> resolve(const FrameRequest& request, bool gpuDrawsMaps);
  std::optional<OcclusionMethod> choose();
  bool mapHidLittleNear() const;

  /// What the visible set depends on.
  struct VisibleKey {
    EyePose eye;
    ViewShape view;
    CullingCase method = CullingCase::none;
    bool backFaces = false;
    double farM = 0;
    CutNumber cut;
    std::optional<OcclusionMethod> serves;
    DepthMapSize size;
    std::uint64_t horizon = 0;   ///< which one said what it hides; 0: none
    std::uint64_t surfaces = 0;  ///< that were made
    friend bool operator==(const VisibleKey&, const VisibleKey&) = default;
  };
  /// Where a map hid next to nothing.
  struct Barren {
    Vec3 eye, forward;
    std::uint64_t rule = 0;
    DepthMapSize size;
    OcclusionMethod method;
  };

  OcclusionGround& ground_;
  OcclusionResult result_;
  FrameCounters counters_;
  HorizonMemory memory_;
  OcclusionChoice choice_;
  bool chosen_ = false;  ///< by cost, in this frame
  int unlearnt_ = 0;     ///< frames in a row
  Defects defects_;
  int subpixelBits_ = 4;
  EyePose eye_;
  ViewShape view_;
  DepthMapSize size_;
  std::string refusal_;  ///< why nothing may be hidden from the eye
  std::optional<OcclusionMethod> serves_;
  std::span<const std::uint8_t> hidden_;
  bool mapHid_ = false;  ///< the processor's map had a part in the visible set
  std::optional<VisibleKey> visibleKey_;
  std::optional<Barren> barren_;
};

}  // namespace trimtab::scene
