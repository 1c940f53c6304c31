#pragma once

#include <span>

#include "trimtab/frame/frame.h"

namespace trimtab {

struct GeometricError {
  double maxPx = 0, meanPx = 0;  ///< mean over all pixels of the picture
};

/// Screen-space geometric error between two pictures of one view, from what they show and not from stated
/// bounds. Distances are metres from the eye, row 0 at the bottom, infinity (or no number above 0) where
/// nothing was drawn (Renderer::readDistances).
///
/// Each picture bounds the space that the eye sees. Its boundary is taken to be the points of the pixels'
/// centres, joined by straight lines from each pixel to the next in its row and column: on across a
/// silhouette, where the line is the edge of a shadow, and without end where sky is beside ground. Points
/// alone would not do: where ground is seen at a grazing angle, they lie hundreds of pixels' spans behind
/// each other, and a shift of half a pixel would count as those.
/// Nothing lies between the lines of a cell: that adds at most half a pixel aside, sqrt(e^2 + 1/4) for e.
///
/// A pixel's error is the distance in space from its point to the nearest line of the other picture that lies
/// within `windowPx` pixels, in pixels' spans at the pixel's depth: a displacement across the view counts as
/// the pixels that it moves in the picture. Sky is a direction: the error of a pixel of sky is the distance
/// in the picture to the nearest sky. What lies outside the picture is unknown and taken to fit, so a pixel's
/// error is at most its distance to the picture's edge; an error that the window cannot hold is `windowPx`.
/// Both directions are measured, the larger maximum and the larger mean returned; NaN where the spans do not
/// hold a picture of the view's size, or hold none.
///
/// Cost: nothing where both show the same, else some 20 ns a pixel while errors are below a pixel; each pixel
/// that errs by e pixels looks at up to 8 e^2 lines.
GeometricError geometricError(std::span<const float> reference, std::span<const float> ours,
                              const ViewShape& view, int windowPx = 32);

}  // namespace trimtab
