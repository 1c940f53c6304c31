#pragma once

#include <span>

#include "trimtab/frame/frame_request.h"
#include "trimtab/scene/error_meter.h"

namespace trimtab::experiment {

/// Says how far an image is from its reference, in mean FLIP.
struct ExposedError {
  double sharp = 0;    ///< as if the image were looked at in peace
  double smeared = 0;  ///< with both images smeared by the motion of the line of sight during the exposure
};

/// Measures an image that a display holds for `exposureMs` while the line of sight turns as it did since the
/// image before. Image and reference are drawn at times all over the exposure and each are averaged. They are
/// drawn once if the exposure smears by less than a pixel, or if there is no image before. `before` is as for
/// ErrorMeter::measure.
ExposedError exposedError(scene::ErrorMeter& meter, const FrameRequest& request,
                          std::span<const FrameRequest> before, double exposureMs);

}  // namespace trimtab::experiment
