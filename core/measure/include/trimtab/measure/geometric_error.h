#pragma once

#include <span>
#include <vector>

#include "trimtab/frame/frame.h"

namespace trimtab {

struct GeometricError {
  double maxPx = 0, meanPx = 0;  ///< the mean is over all pixels of the image
};

/// Returns the screen-space geometric error between two images of one view, measured in the images and not
/// from stated bounds. Distances are metres from the eye, row 0 at the bottom, infinity (or no number above
/// 0) where nothing was drawn (Renderer::readDistances).
///
/// The surface of an image is taken to be the points at its pixels' centres, joined by straight lines from
/// each pixel to the next in its row and column, also across silhouettes, and without end where sky is beside
/// ground. Points alone do not suffice: ground seen at a grazing angle has points hundreds of pixels' spans
/// behind each other, so that a shift of half a pixel would count as hundreds. The lines leave the middle of
/// a cell open, which adds at most half a pixel: sqrt(e^2 + 1/4) for an error of e.
///
/// A pixel's error is the distance in space from its point to the nearest line of the other image within
/// `windowPx` pixels, divided by a pixel's span at its depth, so that a displacement across the view counts
/// as the pixels that it moves. Sky is a direction: the error of a pixel of sky is the distance in the image
/// to the nearest sky. What lies outside the image is unknown and assumed to fit, so a pixel's error is at
/// most its distance to the image's edge. An error that exceeds the window is `windowPx`. Both directions are
/// measured, and the larger maximum and the larger mean are returned; NaN if the spans do not hold an image
/// of the view's size, or an empty one.
///
/// The cost is nothing where both images agree, else about 20 ns per pixel while errors are below a pixel; a
/// pixel with an error of e pixels looks at up to 8 e^2 lines.
GeometricError geometricError(std::span<const float> reference, std::span<const float> ours,
                              const ViewShape& view, int windowPx = 32);

/// Returns a reference's distances up to a far cut, metres, beyond which nothing was drawn. What the cut
/// takes from an image shows in its colours, as fog, and is no geometric error.
std::vector<float> distancesUpTo(double farM, std::vector<float> distances);

}  // namespace trimtab
