#pragma once

#include <array>

#include "trimtab/frame/weather_decision.h"

namespace trimtab::scene {

/// The air of one frame as air.glsl uses it.
struct Air {
  static constexpr float kFarthest = 1e30f;

  bool clear = true;              ///< uses the shaders of clear weather
  float extinction = 0;           ///< per metre
  float cutM = kFarthest;         ///< from the eye; nothing is drawn beyond
  float fadePerM = 1;             ///< 1 / the metres before the cut in which colours fade
  bool layered = false;           ///< only below `topM` there is fog
  float topM = 0;                 ///< above mean sea level
  std::array<float, 3> colour{};  ///< of fog, sRGB

  friend bool operator==(const Air&, const Air&) = default;
};

/// Fog reaches this far above the eye, metres. No terrain that the eye can see stands higher above it, so
/// the sky behind a mountain that the cut takes away is at least as deep in fog as the mountain was.
inline constexpr double kFogTopM = 5000;
/// The part of the visible distance before the cut in which colours fade to the fog.
inline constexpr double kCutFade = 0.15;

/// Returns the air of a decision; any decision gives air that can be drawn. An extinction that is negative
/// or not a number means no fog, an infinite one hides everything; a far distance that is not a number cuts
/// nothing, one below 0 everything.
Air airOf(const WeatherDecision& weather, double farM);

/// Holds what haze_layer.glsl and sky.frag.glsl need to know of a layer, from the heights of the eye and of
/// its top, metres above mean sea level.
struct LayerRoots {
  double fromCentre = 0;  ///< of the earth to the eye
  double top = 0;         ///< the square of that, less the square of the layer's radius
  double lowest = 0;      ///< the same for a sphere below all ground and below the eye
};
LayerRoots layerRoots(double eyeM, double topM);

}  // namespace trimtab::scene
