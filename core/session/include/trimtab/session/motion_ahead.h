#pragma once

#include <optional>
#include <span>
#include <vector>

#include "trimtab/hold/frame_hold.h"

namespace trimtab {

/// Extrapolates the eye from image to image: where it will be in the next images.
class MotionAhead {
 public:
  static constexpr std::size_t kMostImages = 30;

  /// Adds the eye of the image that is about to be drawn. A time that stands, goes back or jumps by more than
  /// a quarter of a second forgets the motion.
  void push(double timeS, const ComingEye& eye);
  /// Returns the eyes of the next `images` images, at most kMostImages, nearest first, if the eye moves on as
  /// it did since the last image; none if no motion is known. They stay valid until the next call.
  std::span<const ComingEye> coming(std::size_t images);

 private:
  std::optional<double> timeS_;
  ComingEye last_, step_;  ///< `step_`: differences from image to image
  bool moves_ = false;
  std::vector<ComingEye> coming_;
};

}  // namespace trimtab
