#pragma once

#include <limits>
#include <string>

#include "trimtab/frame/frame.h"

/// Weather of a frame: what falls, how far one sees, where the far plane stands (document D).
namespace trimtab {

/// Precipitation and visibility of `state` under `parameters`, and the far plane by Eq. (1). Pure; no
/// allocation; the same bits on every replay. A host's visibility that is no number above 0 counts as none;
/// one outside 10 m .. 1,000 km as the nearest of the two, infinity as unlimited.
WeatherDecision decideWeather(const AircraftState& state, const TuningParameters& parameters);

/// Far plane and ratio for a visibility that `decision` holds already, by mode: what decideWeather does last,
/// and what calibration varies. `stretch` (at least 1) counts in the adaptive mode only.
void setFarPlane(WeatherDecision& decision, const WeatherParameters& parameters, double stretch);

/// -ln(threshold) / visibility, 1/m. 0 for an unlimited visibility; the arguments are otherwise above 0.
///
/// The threshold is the contrast that is left at the visibility. 0.02 (the default) is Koschmieder's visual
/// range, what an observer can just tell from the sky: a cut there removes what nobody could see, which is
/// what Eq. (1) promises. The 0.05 of the meteorological optical range (what transmissometers and METAR
/// report) would leave 13 of 255 levels at the cut.
double extinction(double visibilityM, double contrastThreshold);

/// What falls in a step.
Precipitation precipitationOf(WeatherStep step);
/// The step's own group; null for clear.
const WeatherStepParameters* stepParameters(const TuningParameters& parameters, WeatherStep step);
WeatherStepParameters* stepParameters(TuningParameters& parameters, WeatherStep step);
/// Where the preset puts the visibility of a step, metres: typed, or the step's share of the clear-day
/// distance.
double stepVisibilityM(const TuningParameters& parameters, WeatherStep step);

/// The step's parameters at a density between those of light, medium and heavy: on straight lines, from clear
/// weather (all of the clear-day distance, no stretch) at 0 on; held beyond the densest. What a host's
/// severity is drawn with.
WeatherStepParameters stepParametersAt(const TuningParameters& parameters, Precipitation precipitation,
                                       double density);

/// The decision in words and numbers: one line.
std::string explain(const WeatherDecision& decision);

}  // namespace trimtab
