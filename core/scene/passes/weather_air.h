#pragma once

#include <array>

#include "trimtab/frame/weather_decision.h"

namespace trimtab::scene {

/// The air of one frame as air.glsl uses it.
struct Air {
  static constexpr float kFarthest = 1e30f;

  bool clear = true;       ///< the shaders of clear weather are used: not a bit of today's picture changes
  float extinction = 0;    ///< a metre
  float cutM = kFarthest;  ///< from the eye; nothing beyond
  float fadePerM = 1;      ///< 1 / metres before the cut over which what is left of a colour goes to 0
  std::array<float, 3> colour{};  ///< of fog, sRGB

  friend bool operator==(const Air&, const Air&) = default;
};

/// Haze of clear air, sRGB: the colour of the horizon, and of fog that is thin.
inline constexpr std::array<float, 3> kHaze{0.74f, 0.80f, 0.86f};
/// Fog reaches so far above the eye. No terrain stands higher above an eye that it can be seen from, so the
/// sky behind a mountain that the cut takes away is at least as deep in fog as the mountain was.
inline constexpr double kFogTopM = 5000;
/// The part of the visible distance before the cut in which the rest of a colour fades.
inline constexpr double kCutFade = 0.15;

/// Any decision gives air that can be drawn. An extinction that is no number or negative is no fog, an
/// infinite one hides everything; a far distance that is no number cuts nothing, one below 0 everything.
Air airOf(const WeatherDecision& weather);

}  // namespace trimtab::scene
