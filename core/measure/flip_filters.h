#pragma once

#include <vector>

#include "image_kernels.h"

namespace trimtab {

/// FLIP's filters for a number of pixels a degree, and what its kernels need of them.
class FlipFilterBank {
 public:
  /// Pixels a degree that a filter can be made for; beyond them there is none that means something.
  static constexpr double kLeastPixelsPerDegree = 1, kMostPixelsPerDegree = 4000;

  explicit FlipFilterBank(double pixelsPerDegree);
  const FlipFilters& filters() const { return filters_; }
  /// Returns how far, in pixels, the filters of an error reach.
  int radius() const { return radius_; }

 private:
  HalfFilter keep(const std::vector<double>& half, double sum);

  int radius_ = 0;
  FlipFilters filters_;
  std::vector<std::vector<float>> weights_;
};

/// Returns what each byte of each channel adds to luminance, X - Y and Y - Z, each a share of the white
/// point's.
const FlipTable& flipTable();

}  // namespace trimtab
