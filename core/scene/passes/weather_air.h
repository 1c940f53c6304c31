#pragma once

#include <array>

#include "trimtab/frame/weather_decision.h"

// What air leaves of a colour, for the fragment shader of whatever has a place in the world. The distance
// comes from the fragment's own coordinates, so that it is that of the pixel and no varying is needed. Where
// the view is cut, what lies farther is not there: the sky behind it shows, and not the tiles' outline.
#define TRIMTAB_AIR                                                                                       \
  "#ifdef IN_WEATHER\n"                                                                                   \
  "uniform vec4 tangents;\n"    /* left, right, bottom, top */                                            \
  "uniform vec2 pictureSize;\n" /* pixels */                                                              \
  "uniform vec3 fog;\n"         /* sRGB */                                                                \
  "uniform vec3 air;\n"         /* extinction a metre, cut distance, 1 / width of its fade */             \
  "vec3 throughAir(vec3 colour) {\n"                                                                      \
  "  vec2 across = mix(tangents.xz, tangents.yw, gl_FragCoord.xy / pictureSize);\n"                       \
  "  float metres = sqrt(1.0 + dot(across, across)) / gl_FragCoord.w;\n"                                  \
  "  if (metres > air.y) discard;\n"                                                                      \
  "  float near = clamp((air.y - metres) * air.z, 0.0, 1.0);\n"                                           \
  "  return mix(fog, min(colour, vec3(1.0)), exp(-air.x * metres) * near * near * (3.0 - 2.0 * near));\n" \
  "}\n"                                                                                                   \
  "#else\n"                                                                                               \
  "vec3 throughAir(vec3 colour) { return colour; }\n"                                                     \
  "#endif\n"

namespace trimtab::scene {

/// The air of one frame as the shaders take it.
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
