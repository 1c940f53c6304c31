#pragma once

#include "trimtab/frame/frame.h"

/// Widens the view that GL knows beyond the image, so that GL cuts next to no triangle and judges all of
/// them alike. Otherwise llvmpipe may drop a sliver on a ridge and show what lies behind the mountain.
/// resources/docs/occlusion.md, Back faces and the guard band, has the reason, the cost, and why judging by
/// rounded corners opens no gap.
namespace trimtab::scene {

/// The limits of a context's viewports.
struct ViewportLimits {
  int widthPx = 0, heightPx = 0;  ///< at most
  bool beginAtHalves = false;     ///< of pixels
};
/// Returns those of the current context.
ViewportLimits viewportLimitsOfContext();

/// Returns how many times wider and higher than the image the band is: a power of two, so that rounding
/// moves no vertex, or 1 if viewports are too small, or begin at whole pixels only and the image's size is
/// odd.
int guardBandOf(const ViewShape& view, const ViewportLimits& limits);

/// Returns the view that GL does not cut, `times` as wide and high about the image's middle.
ViewShape withGuardBand(const ViewShape& view, int times);

/// Sets the viewport for it while it lives, and then the image's again. The framebuffer ends where the image
/// does.
class WideViewport {
 public:
  WideViewport(const ViewShape& view, int times);
  ~WideViewport();
  WideViewport(const WideViewport&) = delete;
  WideViewport& operator=(const WideViewport&) = delete;

 private:
  int widthPx_, heightPx_;
};

}  // namespace trimtab::scene
