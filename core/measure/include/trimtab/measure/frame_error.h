#pragma once

#include <cstdint>
#include <limits>

namespace trimtab {

/// What one picture lost against its reference: the same view without culling, at the finest levels, without
/// blur and without an early far plane, in the same air. NaN where an error was not measured.
struct FrameError {
  static constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

  std::uint64_t wronglyCulledPixels = 0;  ///< owned by a tile that was left out; of the same levels unculled
  /// How far, in pixels, what the picture shows lies from where the reference shows it, and the other way
  /// round (geometric_error.h).
  double geometricMaxPx = kNotMeasured, geometricMeanPx = kNotMeasured;
  double psnrDb = kNotMeasured;  ///< infinity: equal
  double ssim = kNotMeasured;    ///< mean over luma, 1: equal
  double flip = kNotMeasured;    ///< mean, 0: equal
  /// Temporal pop: mean change of a channel since the frame before, of 255, that the reference does not show.
  double pop = kNotMeasured;
  double hiddenDrawnShare = kNotMeasured;  ///< of the tiles drawn: those that own no pixel

  friend bool operator==(const FrameError&, const FrameError&) = default;
};

}  // namespace trimtab
