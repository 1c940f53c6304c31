#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "occlusion_ground.h"
#include "trimtab/culling/moving_horizon.h"
#include "trimtab/culling/occlusion_choice.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/scene/distance_image.h"

namespace trimtab::scene {

/// Returns the elevations of a horizon in so many directions of equal distance, clockwise from south,
/// degrees; NaN where it has no ground.
std::vector<float> elevationsOf(const Horizon& horizon, int samples);

/// The horizon of a moving eye, which is left out where it would hide next to nothing.
class HorizonMemory {
 public:
  /// What one frame found, and the work that it did.
  struct Result {
    /// One flag per tile of the cut, in its order: 1 if it is proven hidden, whatever the view direction.
    /// Empty if the horizon was left out or cannot be built. Valid until the next call.
    std::span<const std::uint8_t> hidden;
    std::span<const std::uint8_t> hiddenBoxes;  ///< likewise, one per box of the ground
    bool noGraph = false;     ///< no horizon can be built, because a place may have two heights
    bool leftOut = false;     ///< not looked for, because near here a horizon hid next to nothing
    bool moved = false;       ///< a horizon that was built for an earlier eye position was used
    std::uint64_t built = 0;  ///< horizons begun in this frame
  };
  /// Discards the horizon.
  void clear();
  /// Counts a frame. Call it in every frame, also without find(), so that the eye's speed is known.
  void beginFrame() { ++frame_; }
  /// Finds which tiles of the ground's cut are hidden from an eye that the ground does not refuse. With
  /// skips.littleHidden it does nothing while the eye is within kBelievedM of where next to nothing was
  /// hidden, under the same LOD rule. If `alone` is true a horizon is built at once at every new eye
  /// position, so that the result depends on no earlier frame.
  Result find(OcclusionGround& ground, Vec3 eye, const Horizon::Settings& settings, const Skips& skips,
              bool alone = false);
  /// Returns the view as the last horizon sees it, row 0 at the bottom: grey where it hides, white where it
  /// does not.
  DistanceImage picture(const EyePose& eye, const ViewShape& view, int widthPx, int heightPx) const;

  const Horizon& horizon() const { return moving_.horizon(); }
  std::uint64_t number() const { return number_; }  ///< a new number for each horizon that is used

  /// Returns true if so little of all tiles is hidden that no more is expected within kBelievedM.
  static bool isLittle(std::size_t hidden, std::size_t of) { return hidden * 50 < of; }
  static constexpr double kBelievedM = OcclusionChoice::kBelievedM;

  /// Returns the columns per quarter of the circle for a width of the occlusion resolution (OcclusionStage).
  static int columnsFor(int resolutionWidthPx);
  /// Returns the angle, radians, by which a rasteriser may shift a direction if its vertices keep so many
  /// bits of a pixel.
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
  bool hidLittle_ = false;
  /// Where next to none of the boxes was hidden. Horizons begun near there leave the boxes out.
  std::optional<Vec3> boxesHidLittleAt_;
  std::size_t missingThen_ = 0;              ///< surfaces that were missing when a horizon was last begun
  std::uint64_t frame_ = 0, lastFrame_ = 0;  ///< this frame, and that of the last find()
  std::uint64_t number_ = 0;
};

}  // namespace trimtab::scene
