#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "occlusion_ground.h"
#include "trimtab/culling/moving_horizon.h"
#include "trimtab/culling/occlusion_choice.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/scene/distance_image.h"

namespace trimtab::scene {

/// A horizon that goes with the eye, and is left out where it would hide next to nothing.
class HorizonMemory {
 public:
  /// Forgets it.
  void clear();
  /// In every frame, whether it is asked or not: so it knows how fast the eye goes.
  void beginFrame() { ++frame_; }
  /// Which tiles are proven hidden from an eye that the ground does not refuse, in the cut's order, whatever
  /// the view's direction. Empty where nothing is: also, where `skips.littleHidden`, while the eye has moved
  /// little since next to nothing was, by the same rule for the levels. `alone`: built whole at every new
  /// place, never taken along from another.
  std::span<const std::uint8_t> hidden(OcclusionGround& ground, Vec3 eye, const Horizon::Settings& settings,
                                       const Skips& skips, bool alone = false);
  /// The view as the last horizon sees it: what it covers grey, what stays open white. Row 0 at the bottom.
  DistanceImage picture(const EyePose& eye, const ViewShape& view, int widthPx, int heightPx) const;

  /// Whether the last call had no graph to make a horizon of.
  bool noGraph() const { return noGraph_; }

  const Horizon& horizon() const { return moving_.horizon(); }
  std::uint64_t number() const { return number_; }         ///< another one for another horizon
  std::uint64_t built() const { return moving_.built(); }  ///< horizons, since the start
  std::uint64_t moved() const { return moved_; }           ///< frames that an earlier one served
  /// Calls since the start that skips.littleHidden spared.
  std::uint64_t leftOut() const { return leftOut_; }

  /// Where so little of all tiles is hidden, no more is believed to be for kBelievedM around.
  static bool isLittle(std::size_t hidden, std::size_t of) { return hidden * 50 < of; }
  static constexpr double kBelievedM = OcclusionChoice::kBelievedM;

  /// Columns of a quarter of the circle for a depth map of this width.
  static int columnsFor(int depthMapWidthPx);
  /// How far rasterising may shift a direction, radians, where vertices keep so many bits of a pixel.
  static double slackOf(const ViewShape& view, int subpixelBits);

 private:
  struct Key {
    Vec3 eye;
    CutNumber cut;
    Horizon::Settings settings;
    friend bool operator==(const Key&, const Key&) = default;
  };
  bool hidLittleNear(const Key& key) const;

  MovingHorizon moving_;
  std::optional<Key> key_;
  bool hidLittle_ = false, noGraph_ = false;
  std::size_t lacked_ = 0;                   ///< surfaces, when a horizon was last begun
  std::uint64_t frame_ = 0, lastFrame_ = 0;  ///< of now, and when it was last asked
  std::uint64_t number_ = 0, moved_ = 0, leftOut_ = 0;
};

}  // namespace trimtab::scene
