#pragma once

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <string_view>

#include "trimtab/preset/parameters.h"
#include "trimtab/units/linear.h"

/// Holds what the weather of a frame is decided to be. core/weather decides it, and the renderer's passes
/// draw it.
namespace trimtab {

enum class Precipitation : std::uint8_t { none, rain, snow };

/// Says where precipitation and visibility come from. Names in quotes are fields of WeatherParameters.
enum class WeatherReason : std::uint8_t {
  clear,               ///< nothing falls, and nothing limits the view
  haze,                ///< nothing falls, and the visibility is the preset's `clearVisibility`
  step,                ///< both come from the preset's `step`
  typed,               ///< the preset's `step` says what falls; the visibility is its `typedVisibility`
  host,                ///< the host said it; if it said only what falls, the preset has the visibility
  host_said_nothing,   ///< the host has not spoken of weather yet, so both come from the preset's `step`
  invalid_visibility,  ///< the host's visibility is no number above 0, so it is the preset's for what the
                       ///< host says falls
  visibility_limited   ///< the host's visibility is clamped to the range that can be drawn
};

/// Says why the far plane is where it is.
enum class FarReason : std::uint8_t {
  off,        ///< the ratio mode is off
  clear,      ///< nothing is cut, because no fog would hide the edge
  fixed,      ///< the preset's `fixedRatio` sets it
  visible,    ///< it lies at the visibility, by Eq. (1) of document D
  stretched,  ///< it lies farther, by the `farStretch` of what falls, which a calibration finds
  safe,       ///< it lies where nothing can be seen any more: at `safeFarM`
  unbounded   ///< there is none, because something may be seen through the air at any distance
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

/// Rain or snow on its way from one density to another.
struct FadingPrecipitation {
  Precipitation kind = Precipitation::none;
  double density = 0;  ///< 0..1, of the particles' size and fall speed
  double amount = 0;   ///< 0..1, of their number: on its way to the density, or to 0

  friend bool operator==(const FadingPrecipitation&, const FadingPrecipitation&) = default;
};

/// A default decision is clear weather with nothing cut, which is also what the preset `default` decides.
///
/// Fog is exponential: of an object's own colour exp(-extinctionPerM * distance) is left. At `visibilityM`
/// that share is the contrast threshold (WeatherParameters) and not 0. So a pass that cuts there must fade
/// colours to the fog's before `farM`, or an edge shows, unless `farM` is at least `safeFarM`.
struct WeatherDecision {
  static constexpr double kUnlimited = std::numeric_limits<double>::infinity();

  Precipitation precipitation = Precipitation::none;
  double density = 0;               ///< particle intensity, 0..1; 0 when nothing falls
  bool fogged = false;              ///< if false, draw without fog, whatever visibility and extinction say
  double visibilityM = kUnlimited;  ///< distance from the eye, not depth along the view's axis
  double extinctionPerM = 0;        ///< -ln(contrast threshold) / visibilityM
  double layerTopM = kUnlimited;    ///< above mean sea level; only below it there is fog
  /// Beyond it no channel of any pixel can differ by more than 1/255 (safeFarM in weather.h); unlimited where
  /// something may be seen at any distance, and in document D's fog, which does not use it.
  double safeFarM = kUnlimited;
  double nearFarRatio = 0;  ///< WeatherParameters::defaultNear / farM; 0 while nothing is cut
  /// Nothing farther from the eye is drawn. In a frame request a policy may have multiplied it (applyLevers),
  /// and divided nearFarRatio by as much.
  double farM = kUnlimited;
  WeatherReason reason = WeatherReason::clear;
  FarReason farReason = FarReason::clear;

  friend bool operator==(const WeatherDecision&, const WeatherDecision&) = default;
};

/// These return the name that traces, the command line and the workbench show, and an empty one for a value
/// outside the enumeration.
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
  constexpr std::string_view kNames[] = {"off",       "clear", "fixed",    "visible",
                                         "stretched", "safe",  "unbounded"};
  const auto at = static_cast<std::size_t>(reason);
  return at < std::size(kNames) ? kNames[at] : std::string_view{};
}

}  // namespace trimtab
