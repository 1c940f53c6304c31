#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "trimtab/weather/weather.h"

/// The four-step calibration of document D on measured times: what a weather step costs, what the cut of Eq.
/// (1) saves, and how far the far plane may be moved out until both match. It only searches; the caller
/// measures.
namespace trimtab {

/// Measures a frame with this weather and everything else unchanged, in milliseconds; returns nothing to stop
/// the calibration. It is called several times for each decision (`CalibrationSettings::repeats`) and may be
/// noisy.
using MeasureFrame = std::function<std::optional<double>(const WeatherDecision&)>;

struct CalibrationSettings {
  double tolerance = 0.05;    ///< as a share of a clear frame's time
  double farthestM = 200e3;   ///< no terrain lies farther, so a cut there removes nothing
  int repeats = 3;            ///< measurements per decision, of which the median counts
  int mostTrials = 12;        ///< far planes, or densities, that a search tries
  double densityStep = 0.01;  ///< a fitting density is searched this closely
};

enum class CalibrationOutcome {
  matched,         ///< gain and loss match at `farM`
  costs_nothing,   ///< the step costs less than the tolerance, so nothing needs to be cut
  cut_not_enough,  ///< the strongest cut saves less than the step costs; `density` is the one that fits
  fog_not_enough,  ///< not even density 0 fits: the fog itself, or what is near, costs more than the cut
                   ///< saves
  not_settled,     ///< no far plane that was tried matched within the tolerance; `farM` is the nearest match
  not_a_number     ///< a measurement was no finite number above 0
};
/// Returns the outcome as a sentence.
std::string_view toText(CalibrationOutcome outcome);

/// One far plane and density that were tried.
struct CalibrationTrial {
  double farM = 0;  ///< infinity if nothing is cut
  double density = 0;
  double ms = 0;

  friend bool operator==(const CalibrationTrial&, const CalibrationTrial&) = default;
};

struct StepCalibration {
  WeatherStep step = WeatherStep::clear;
  CalibrationOutcome outcome = CalibrationOutcome::matched;
  double clearMs = 0;      ///< clear weather, measured just before the step
  double uncutMs = 0;      ///< the step without a cut
  double strongestMs = 0;  ///< the step, cut at the visibility
  double matchedMs = 0;    ///< the step at `farM` and `density`
  double visibilityM = 0;
  double farM = 0;
  double nearFarRatio = 0;  ///< default near / farM
  double density =
      0;  ///< the density that fits; the preset's unless the outcome is that the cut is not enough
  double presetDensity = 0;  ///< what was measured
  double clearAfterMs = 0;   ///< clear weather again, after the step; another time shows a busy machine
  bool drifted = false;      ///< both clear times differ by more than the tolerance
  /// The times contradict each other: a farther cut was faster than a nearer one by more than the tolerance,
  /// or every far plane up to the terrain's end was faster than clear weather, and no far plane at all was
  /// slower.
  bool notMonotone = false;
  std::vector<CalibrationTrial> trials;

  double lossMs() const { return uncutMs - clearMs; }
  double gainMs() const { return uncutMs - matchedMs; }
  double strongestGainMs() const { return uncutMs - strongestMs; }
  double farStretch() const { return farM / visibilityM; }
};

/// Runs steps 1 to 4 for one weather step other than clear. Returns nothing if the measuring stopped.
///
/// The frame's time is assumed to rise with the far plane and with the density. If it does not, by noise or
/// by nature, the result is the trial that came closest to the clear frame's time, and `notMonotone` is set.
std::optional<StepCalibration> calibrateStep(WeatherStep step, const TuningParameters& parameters,
                                             const MeasureFrame& measure,
                                             const CalibrationSettings& settings);

/// Returns why a result says nothing about the weather, as a sentence without a full stop; empty if it may be
/// written. A machine that was busy meanwhile gives such results.
std::string whyRejected(const StepCalibration& calibration);

/// Writes the far plane and the density of a step into the parameters, with the adaptive ratio. Values are
/// clamped to the parameters' ranges. It does not look at `whyRejected`; see applyAccepted().
void apply(const StepCalibration& calibration, TuningParameters& parameters);

struct RejectedStep {
  WeatherStep step = WeatherStep::clear;
  std::string why;
};
/// Writes every result that is not rejected, as apply() does, and returns the others.
std::vector<RejectedStep> applyAccepted(std::span<const StepCalibration> results,
                                        TuningParameters& parameters);

}  // namespace trimtab
