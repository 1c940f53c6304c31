#include "trimtab/scene/weather_cut_error.h"
#include "trimtab/frame/frame_request.h"

#include <algorithm>
#include <cstdlib>

namespace trimtab::scene {

CutError cutError(Renderer& renderer, const FrameRequest& request, unsigned fbo) {
  CutError error;
  const ViewShape& v = request.view;
  if (v.widthPx <= 0 || v.heightPx <= 0) return error;
  const auto pixelsOf = [&](const FrameRequest& r) {
    renderer.draw(r, fbo);
    return renderer.readPixels(v.widthPx, v.heightPx);
  };
  FrameRequest whole = request;
  whole.levers.drawn.farM = WeatherDecision::kUnlimited;
  const auto before = pixelsOf(whole), after = pixelsOf(request);
  error.pixels = before.size() / 4;
  for (std::size_t i = 0; i < before.size(); i += 4) {
    int most = 0;
    for (std::size_t c = i; c < i + 3; ++c) most = std::max(most, std::abs(int{before[c]} - int{after[c]}));
    error.changed += most > 0;
    error.largest = std::max(error.largest, most);
  }
  return error;
}

}  // namespace trimtab::scene
