#pragma once

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <string_view>

#include "trimtab/preset/parameters.h"
#include "trimtab/units/linear.h"

/// Holds what the weather of a frame is decided to be. core/weather decides it, and the renderer's passes
/// draw it. resources/docs/glossary.md says what document D is.
namespace trimtab {

enum class Precipitation : std::uint8_t { none, rain, snow };

/// Says where precipitation and visibility come from. Names in quotes are fields of WeatherParameters.
enum class WeatherReason : std::uint8_t {
  clear,               ///< nothing falls, and nothing limits the view
  haze,                ///< nothing falls, and the visibility is the preset's `clearVisibility`
  step,                ///< both come from the preset's `step`
  typed,               ///< as `step`, but the visibility is the preset's `typedVisibility`
  host,                ///< the host said it; without a visibility from the host, the preset's for what falls
                       ///< counts, and if the host said nothing of precipitation, nothing falls
  host_said_nothing,   ///< the host has not spoken of weather yet, so both come from the preset
  invalid_visibility,  ///< no visibility that the host sent is a number above 0, so the preset's for what
                       ///< falls counts
  visibility_limited   ///< the host's visibility is clamped to the range that can be drawn (decideWeather)
};

/// Says why the far plane is where it is.
enum class FarReason : std::uint8_t {
  off,        ///< nothing is cut, because the preset's `ratioMode` is off
  clear,      ///< nothing is cut, because no fog would hide the edge, and the ratio is not fixed
  fixed,      ///< the preset's `fixedRatio` sets it
  visible,    ///< it lies at the visibility, by Eq. (1) of document D
  stretched,  ///< it lies at the visibility times the `farStretch` of what falls, which a calibration finds
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

/// Rain or snow that begins, changes or ends over some seconds (PrecipitationFade).
struct FadingPrecipitation {
  Precipitation kind = Precipitation::none;  ///< what falls at this moment; an old kind ends before a new one
  double density = 0;  ///< 0..1, gives the particles their size and fall speed; it changes at once
  double amount = 0;   ///< 0..1, gives their number; it moves to the density, or to 0 where the kind ends

  friend bool operator==(const FadingPrecipitation&, const FadingPrecipitation&) = default;
};

/// A default decision is clear weather with nothing cut, which is also what the preset `default` decides.
///
/// Fog is exponential: the share exp(-extinctionPerM * distance) of an object's own colour is left. At
/// `visibilityM` this share is the contrast threshold and not 0: WeatherParameters::contrastThreshold in
/// AirModel::uniform, kOpticalRangeContrast (haze_layer.h) in AirModel::layer. So a pass that cuts at `farM`
/// must fade colours to the fog's before it, or an edge shows, unless `farM` is at least `safeFarM`.
struct WeatherDecision {
  static constexpr double kUnlimited = std::numeric_limits<double>::infinity();

  Precipitation precipitation = Precipitation::none;
  double density = 0;               ///< particle intensity, 0..1; 0 when nothing falls
  bool fogged = false;              ///< if false, draw without fog, whatever visibility and extinction say
  double visibilityM = kUnlimited;  ///< distance from the eye, not depth along the view's axis
  double extinctionPerM = 0;        ///< -ln(contrast threshold) / visibilityM
  double layerTopM = kUnlimited;    ///< there is fog only below this height above mean sea level
  /// Nothing farther from the eye changes any channel of a pixel by more than 1/255 (haze_layer.h). It is
  /// unlimited if something may be seen at any distance, and in AirModel::uniform, which does not use it.
  double safeFarM = kUnlimited;
  double nearFarRatio = 0;  ///< WeatherParameters::defaultNear / farM; 0 while nothing is cut
  /// Nothing farther from the eye is drawn, unless a policy moves the far distance (FrameLevers::farM).
  double farM = kUnlimited;
  WeatherReason reason = WeatherReason::clear;
  FarReason farReason = FarReason::clear;

  friend bool operator==(const WeatherDecision&, const WeatherDecision&) = default;
};

/// Returns the name that traces, the command line and the workbench show; an empty one for a value outside
/// the enumeration.
constexpr std::string_view toText(Precipitation precipitation) {
  constexpr std::string_view kNames[] = {"none", "rain", "snow"};
  const auto at = static_cast<std::size_t>(precipitation);
  return at < std::size(kNames) ? kNames[at] : std::string_view{};
}
/// Does the same for where the weather comes from.
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
/// Does the same for why the far plane is where it is.
constexpr std::string_view toText(FarReason reason) {
  constexpr std::string_view kNames[] = {"off",       "clear", "fixed",    "visible",
                                         "stretched", "safe",  "unbounded"};
  const auto at = static_cast<std::size_t>(reason);
  return at < std::size(kNames) ? kNames[at] : std::string_view{};
}

}  // namespace trimtab
