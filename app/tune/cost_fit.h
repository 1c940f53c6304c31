#pragma once

#include <span>
#include <vector>

#include "drawn_samples.h"
#include "trimtab/hold/cost_model.h"

namespace trimtab::tune {

/// What images cost, milliseconds.
struct FittedCost {
  ClockCoefficients coefficients;
  double lookingMs = 0;    ///< of looking for hidden ground
  double perInstance = 0;  ///< of an object that is drawn

  /// Returns the time of an image.
  double operator()(const FrameLoad& load, double instances, bool looksForHidden) const;
};

/// Fits the costs to timed images: the non-negative ones with the least squares of relative errors.
FittedCost fitCost(std::span<const TimedImage> images);

}  // namespace trimtab::tune
