#pragma once

#include <span>

#include "trimtab/frame/frame.h"

namespace trimtab {

struct GeometricError {
  double maxPx = 0, meanPx = 0;  ///< mean over all pixels of the picture
};

/// Screen-space geometric error between two pictures of one view, from what they show and not from stated
/// bounds: for each pixel the distance from the point that it shows to the nearest point that the other
/// picture shows within `windowPx` pixels, as the pixels that it spans at the pixel's distance; both
/// directions, the larger. Sky is a direction: only its place in the picture counts. Distances are metres
/// from the eye, row 0 at the bottom, infinity where nothing was drawn (Renderer::readDistances). An error
/// that the window cannot hold is `windowPx`.
GeometricError geometricError(std::span<const float> reference, std::span<const float> ours,
                              const ViewShape& view, int windowPx = 32);

}  // namespace trimtab
