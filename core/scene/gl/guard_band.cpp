#include "guard_band.h"

#include "gl_api.h"
#include "trimtab/scene/gl_report.h"

namespace trimtab::scene {
namespace {

constexpr int kTimes = 4;

}  // namespace

ViewportLimits viewportLimitsOfContext() {
  GLint most[2] = {0, 0}, bits = 0;
  glGetIntegerv(GL_MAX_VIEWPORT_DIMS, most);
  glGetIntegerv(GL_VIEWPORT_SUBPIXEL_BITS, &bits);
  // Mesa's software rasterisers say that they have no bits for it, and keep floats.
  return {most[0], most[1], bits > 0 || contextIsSoftware()};
}

int guardBandOf(const ViewShape& view, const ViewportLimits& limits) {
  // The wide viewport of an odd size begins at half a pixel.
  if ((view.widthPx % 2 != 0 || view.heightPx % 2 != 0) && !limits.beginAtHalves) return 1;
  int times = kTimes;
  while (times > 1 && (view.widthPx > limits.widthPx / times || view.heightPx > limits.heightPx / times))
    times /= 2;
  return times;
}

ViewShape withGuardBand(const ViewShape& view, int times) {
  ViewShape wide = view;
  const double beyondX = 0.5 * (times - 1) * (view.right - view.left),
               beyondY = 0.5 * (times - 1) * (view.top - view.bottom);
  wide.left -= beyondX, wide.right += beyondX;
  wide.bottom -= beyondY, wide.top += beyondY;
  return wide;
}

WideViewport::WideViewport(const ViewShape& view, int times)
    : widthPx_(view.widthPx), heightPx_(view.heightPx) {
  // Floats, as the edge of an odd size is at half a pixel.
  const auto width = static_cast<float>(widthPx_), height = static_cast<float>(heightPx_),
             beyond = 0.5f * static_cast<float>(times - 1), wide = static_cast<float>(times);
  glViewportIndexedf(0, -beyond * width, -beyond * height, wide * width, wide * height);
}

WideViewport::~WideViewport() {
  glViewport(0, 0, widthPx_, heightPx_);
}

}  // namespace trimtab::scene
