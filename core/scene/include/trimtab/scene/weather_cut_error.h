#pragma once

#include "trimtab/frame/frame_request.h"
#include "trimtab/scene/renderer.h"

namespace trimtab::scene {

/// Says how the weather's far cut changed an image.
struct CutError {
  std::size_t pixels = 0;   ///< in the image
  std::size_t changed = 0;  ///< pixels that differ in any channel
  int largest = 0;          ///< largest difference of a channel, 0..255
};

/// Draws the request without and with its far cut and compares the two images. `fbo` keeps the second one.
/// The context must be current. It serves measurements: it costs two frames.
CutError cutError(Renderer& renderer, const FrameRequest& request, unsigned fbo);

}  // namespace trimtab::scene
