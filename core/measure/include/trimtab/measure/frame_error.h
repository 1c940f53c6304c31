#pragma once

#include <cstdint>
#include <limits>

namespace trimtab {

/// Says what one image lost against its reference: the same view without culling, at the finest levels,
/// without blur and without an early far plane, in the same air. An error that was not measured is NaN.
struct FrameError {
  static constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

  std::uint64_t wronglyCulledPixels =
      0;  ///< pixels that an image of the same levels without culling shows of a culled tile
  /// Distance, in pixels, from the surfaces in the image to those in the reference, and the other way round
  /// (geometric_error.h).
  double geometricMaxPx = kNotMeasured, geometricMeanPx = kNotMeasured;
  double psnrDb = kNotMeasured;  ///< infinity if equal
  double ssim = kNotMeasured;    ///< mean over luma; 1 if equal
  double flip = kNotMeasured;    ///< mean; 0 if equal
  /// Temporal pop: the mean change of a channel since the previous frame, of 255, that the reference does not
  /// show.
  double pop = kNotMeasured;
  double hiddenDrawnShare = kNotMeasured;  ///< the share of the tiles drawn that own no pixel

  friend bool operator==(const FrameError&, const FrameError&) = default;
};

}  // namespace trimtab
