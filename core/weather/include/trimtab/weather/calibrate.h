#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "trimtab/weather/weather.h"

/// The four-step calibration of document D, on measured numbers: what a weather step costs, what Eq. (1)'s
/// cut wins back, and how far the far plane may go out until both match. Pure search: the caller measures.
namespace trimtab {

/// Milliseconds of a frame drawn with this weather, everything else as it is; none to stop the calibration.
/// Called several times for one decision (`CalibrationSettings::repeats`) and may be noisy.
using MeasureFrame = std::function<std::optional<double>(const WeatherDecision&)>;

struct CalibrationSettings {
  double tolerance = 0.05;    ///< of a clear frame's time
  double farthestM = 200e3;   ///< nothing of the terrain lies farther: a cut there cuts nothing
  int repeats = 3;            ///< measurements of one decision; their median counts
  int mostTrials = 12;        ///< far planes, or densities, that a search tries
  double densityStep = 0.01;  ///< a fitting density is searched this closely
};

enum class CalibrationOutcome {
  matched,         ///< gain and loss match at `farM`
  costs_nothing,   ///< the step costs less than the tolerance: nothing needs to be cut
  cut_not_enough,  ///< the strongest cut wins less than the step costs; `density` is what fits
  fog_not_enough,  ///< not even at density 0: the fog itself, or what lies near, costs more than the cut wins
  not_settled,     ///< no far plane of the trials matched within the tolerance; `farM` was the nearest match
  not_a_number     ///< a measurement was no finite number above 0
};
/// The outcome in a sentence.
std::string_view toText(CalibrationOutcome outcome);

/// One far plane or density that was tried.
struct CalibrationTrial {
  double farM = 0;  ///< infinity: nothing cut
  double density = 0;
  double ms = 0;

  friend bool operator==(const CalibrationTrial&, const CalibrationTrial&) = default;
};

struct StepCalibration {
  WeatherStep step = WeatherStep::clear;
  CalibrationOutcome outcome = CalibrationOutcome::matched;
  double clearMs = 0;      ///< clear weather, measured just before the step
  double uncutMs = 0;      ///< the step, nothing cut
  double strongestMs = 0;  ///< the step, cut at the visibility
  double matchedMs = 0;    ///< the step at `farM` and `density`
  double visibilityM = 0;
  double farM = 0;
  double nearFarRatio = 0;   ///< default near / farM
  double density = 0;        ///< what fits; the preset's unless the outcome says that the cut is not enough
  double presetDensity = 0;  ///< what was measured
  double clearAfterMs = 0;   ///< clear weather again, after the step: another time tells of a busy machine
  bool drifted = false;      ///< both clear times differ by more than the tolerance
  bool notMonotone = false;  ///< a farther cut was faster than a nearer one by more than the tolerance
  std::vector<CalibrationTrial> trials;

  double lossMs() const { return uncutMs - clearMs; }
  double gainMs() const { return uncutMs - matchedMs; }
  double strongestGainMs() const { return uncutMs - strongestMs; }
  double farStretch() const { return farM / visibilityM; }
};

/// Steps 1 to 4 for one weather step, which is not clear. None when the measuring stopped.
///
/// The frame's time is taken to rise with the far plane and with the density; where it does not, by noise or
/// by nature, the trial that came closest to the clear frame's time is the result and `notMonotone` says so.
std::optional<StepCalibration> calibrateStep(WeatherStep step, const TuningParameters& parameters,
                                             const MeasureFrame& measure,
                                             const CalibrationSettings& settings);

/// Writes far plane and fitting density of a step into the parameters, with the adaptive ratio. Values are
/// brought into the rows' ranges.
void apply(const StepCalibration& calibration, TuningParameters& parameters);

}  // namespace trimtab
