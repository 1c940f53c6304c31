#pragma once

#include "trimtab/scene/renderer.h"
#include "trimtab/frame/frame_request.h"

namespace trimtab::scene {

/// What the weather's far cut took from a picture: the only pass that trades pixels for time.
struct CutError {
  std::size_t pixels = 0;   ///< of the picture
  std::size_t changed = 0;  ///< in any channel
  int largest = 0;          ///< difference of a channel, of 255
};

/// Draws the request without its far cut and with it, and compares. Two frames, and `fbo` is left with the
/// second: for measuring. The context is current.
CutError cutError(Renderer& renderer, const FrameRequest& request, unsigned fbo);

}  // namespace trimtab::scene
