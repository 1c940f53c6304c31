#pragma once

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <string_view>

#include "trimtab/preset/parameters.h"
#include "trimtab/units/linear.h"

/// What the weather of a frame is decided to be: the noun between core/weather, which decides it, and the
/// passes that draw it.
namespace trimtab {

enum class Precipitation : std::uint8_t { none, rain, snow };

/// Where precipitation and visibility come from.
enum class WeatherReason : std::uint8_t {
  clear,               ///< nothing falls, nothing limits the view
  haze,                ///< nothing falls; the preset's clear-day distance
  step,                ///< the preset's step and its visibility
  typed,               ///< the preset's step, the typed visibility
  host,                ///< what the host said
  host_said_nothing,   ///< the host was asked and has not spoken of weather yet: the preset's step
  invalid_visibility,  ///< the host's visibility is no number above 0: that of the preset
  visibility_limited   ///< the host's visibility lies outside what can be drawn: the nearest that can
};

/// Why the far plane is where it is.
enum class FarReason : std::uint8_t {
  off,       ///< the ratio mode is off
  clear,     ///< no fog would hide the cut
  fixed,     ///< the preset's fixed ratio
  visible,   ///< Eq. (1) of document D: at the visibility
  stretched  ///< Eq. (1) with the far plane pushed out until gain and loss match
};

/// Moving air.
struct Wind {
  MetresPerSecond speed;  ///< horizontal
  Degrees from;           ///< where it comes from, clockwise from true north
  MetresPerSecond up;     ///< positive where the air rises

  friend bool operator==(const Wind&, const Wind&) = default;
};
/// Returns the air's velocity, metres per second toward east, north and up.
Vec3 eastNorthUp(const Wind& wind);

/// A default one is clear weather with nothing cut, which is also what the preset `default` decides.
///
/// Fog is exponential: of an object's own colour exp(-extinctionPerM * distance) is left. At `visibilityM`
/// that is the contrast threshold (0.02 by default: 5 of 255 levels), not 0: a pass that cuts there has to
/// lead the rest to the fog's colour before `farM`.
struct WeatherDecision {
  static constexpr double kUnlimited = std::numeric_limits<double>::infinity();

  Precipitation precipitation = Precipitation::none;
  double density = 0;               ///< particle intensity, 0..1; 0 when nothing falls
  bool fogged = false;              ///< false: draw without fog, whatever the numbers below say
  double visibilityM = kUnlimited;  ///< from the eye, not along the view's axis
  double extinctionPerM = 0;        ///< -ln(contrast threshold) / visibilityM
  double nearFarRatio = 0;          ///< 0 while nothing is cut
  double farM = kUnlimited;         ///< default near / nearFarRatio; nothing farther from the eye is drawn
  WeatherReason reason = WeatherReason::clear;
  FarReason farReason = FarReason::clear;

  friend bool operator==(const WeatherDecision&, const WeatherDecision&) = default;
};

/// Names as trace, command line and docks spell them; nothing past the last one.
constexpr std::string_view toText(Precipitation precipitation) {
  constexpr std::string_view kNames[] = {"none", "rain", "snow"};
  const auto at = static_cast<std::size_t>(precipitation);
  return at < std::size(kNames) ? kNames[at] : std::string_view{};
}
constexpr std::string_view toText(WeatherReason reason) {
  constexpr std::string_view kNames[] = {"clear",
                                         "haze",
                                         "step",
                                         "typed",
                                         "host",
                                         "host_said_nothing",
                                         "invalid_visibility",
                                         "visibility_limited"};
  const auto at = static_cast<std::size_t>(reason);
  return at < std::size(kNames) ? kNames[at] : std::string_view{};
}
constexpr std::string_view toText(FarReason reason) {
  constexpr std::string_view kNames[] = {"off", "clear", "fixed", "visible", "stretched"};
  const auto at = static_cast<std::size_t>(reason);
  return at < std::size(kNames) ? kNames[at] : std::string_view{};
}

}  // namespace trimtab
