#pragma once

#include <limits>
#include <optional>
#include <string>

#include "trimtab/frame/frame.h"

/// Decides the weather of a frame: what falls, how far one sees, where the far plane is (document D).
namespace trimtab {

/// Decides precipitation and visibility of a state, and the far plane by Eq. (1). It is pure, allocates
/// nothing and gives the same bits on every replay. A host's visibility counts only if it is a number above
/// 0; it is clamped to 10 m .. 1,000 km, and infinity is unlimited.
/// `highestGround` makes the safe far distance of a layer of haze nearer; if unset, kHighestGroundM is
/// assumed.
WeatherDecision decideWeather(const AircraftState& state, const TuningParameters& parameters,
                              std::optional<Metres> highestGround = {});

/// Sets far plane and ratio of a decision that already holds its visibility and safe far distance, by the
/// mode of the parameters. decideWeather does this last, and the calibration varies it. `stretch` (at least
/// 1) counts in the adaptive mode only.
void setFarPlane(WeatherDecision& decision, const WeatherParameters& parameters, double stretch);

/// Returns the extinction -ln(threshold) / visibility, 1/m; 0 for an unlimited visibility. Both arguments
/// must be above 0.
///
/// The threshold is the contrast that is left at the visibility. The default of 0.02 is Koschmieder's visual
/// range, at which an observer can just tell an object from the sky, so that a cut there removes nothing
/// visible, as Eq. (1) promises. The 0.05 of the meteorological optical range (which transmissometers and
/// METAR report) would leave 13 of 255 levels at the cut.
double extinction(double visibilityM, double contrastThreshold);

/// Returns what falls in a weather step.
Precipitation precipitationOf(WeatherStep step);
/// Returns the parameters of a step; null for clear weather.
const WeatherStepParameters* stepParameters(const TuningParameters& parameters, WeatherStep step);
WeatherStepParameters* stepParameters(TuningParameters& parameters, WeatherStep step);
/// Returns the visibility that the preset gives a step, metres: the typed one, or the step's share of the
/// clear-day distance.
double stepVisibilityM(const TuningParameters& parameters, WeatherStep step);

/// Returns the parameters of a step at a density between those of light, medium and heavy, along straight
/// lines that begin at clear weather (the whole clear-day distance, no stretch) at 0, and constant beyond the
/// densest. A host's severity is drawn with it.
WeatherStepParameters stepParametersAt(const TuningParameters& parameters, Precipitation precipitation,
                                       double density);

/// Returns the wind that carries what falls: the host's, or the preset's if the weather comes from the preset
/// or the host has not sent a wind.
Wind windOf(const AircraftState& state, const WeatherParameters& parameters);

/// Returns the decision in words and numbers, on one line.
std::string explain(const WeatherDecision& decision);

}  // namespace trimtab
