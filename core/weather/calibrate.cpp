#include "trimtab/weather/calibrate.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace trimtab {
namespace {

/// Measures decisions of one step against the clear frame, and keeps what was tried.
class Search {
 public:
  Search(WeatherStep step, const TuningParameters& parameters, const MeasureFrame& measure,
         const CalibrationSettings& settings)
      : parameters_(parameters), measure_(measure), settings_(settings) {
    parameters_.weather.source = WeatherSource::preset;
    parameters_.weather.step = step;
    parameters_.weather.ratioMode = RatioMode::adaptive;
    result_.step = step;
    result_.presetDensity = result_.density = fogged().density;
    result_.visibilityM = fogged().visibilityM;
    result_.farM = std::max(settings.farthestM, result_.visibilityM);
  }

  std::optional<StepCalibration> run();

 private:
  WeatherDecision fogged() const { return decideWeather(AircraftState{}, parameters_); }
  std::optional<double> median(const WeatherDecision& decision);
  std::optional<double> clearFrame();
  /// Measures the step at a far plane (infinity: uncut) and density; the trial is kept.
  std::optional<double> frame(double farM, double density);
  bool pushOut();
  bool thinOut();
  void take(double farM, double density, double ms);
  bool fits(double ms) const { return ms <= result_.clearMs + tolerance(); }
  bool matches(double ms) const { return std::abs(ms - result_.clearMs) <= tolerance(); }
  double tolerance() const { return settings_.tolerance * result_.clearMs; }
  bool isMonotone() const;
  void lookAgain();
  std::optional<StepCalibration> ended();

  TuningParameters parameters_;
  const MeasureFrame& measure_;
  const CalibrationSettings& settings_;
  StepCalibration result_;
  bool stopped_ = false;
};

std::optional<double> Search::median(const WeatherDecision& decision) {
  std::vector<double> times;
  for (int i = 0; i < std::max(settings_.repeats, 1); ++i) {
    const std::optional<double> ms = measure_(decision);
    if (!ms) {
      stopped_ = true;
      return std::nullopt;
    }
    if (!std::isfinite(*ms) || *ms <= 0) {
      result_.outcome = CalibrationOutcome::not_a_number;
      return std::nullopt;
    }
    times.push_back(*ms);
  }
  const auto middle = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
  std::nth_element(times.begin(), middle, times.end());
  return *middle;
}

std::optional<double> Search::clearFrame() {
  TuningParameters clear = parameters_;
  clear.weather.step = WeatherStep::clear;
  clear.weather.visibilityFrom = VisibilitySource::steps;
  clear.weather.haze = false;
  return median(decideWeather(AircraftState{}, clear));
}

std::optional<double> Search::frame(double farM, double density) {
  WeatherDecision decision = fogged();
  decision.density = density;
  if (density <= 0) decision.precipitation = Precipitation::none;
  WeatherParameters mode = parameters_.weather;
  if (std::isinf(farM)) mode.ratioMode = RatioMode::off;
  setFarPlane(decision, mode, std::isinf(farM) ? 1 : farM / decision.visibilityM);
  const std::optional<double> ms = median(decision);
  if (ms) result_.trials.push_back({farM, density, *ms});
  return ms;
}

void Search::take(double farM, double density, double ms) {
  result_.farM = farM;
  result_.density = density;
  result_.matchedMs = ms;
}

/// Step 4: the cut wins more than the weather costs. It goes by halves of the logarithm, because what a far
/// plane costs grows with its square near the eye and with nothing once it is beyond the terrain.
bool Search::pushOut() {
  double low = result_.visibilityM, high = std::max(settings_.farthestM, low);
  result_.outcome = CalibrationOutcome::not_settled;
  take(low, result_.presetDensity, result_.strongestMs);
  for (int trial = 0; trial < settings_.mostTrials && high > low; ++trial) {
    const double farM = std::sqrt(low * high);
    const std::optional<double> ms = frame(farM, result_.presetDensity);
    if (!ms) return false;
    if (std::abs(*ms - result_.clearMs) < std::abs(result_.matchedMs - result_.clearMs))
      take(farM, result_.presetDensity, *ms);
    if (matches(*ms)) {
      result_.outcome = CalibrationOutcome::matched;
      return true;
    }
    (*ms < result_.clearMs ? low : high) = farM;
  }
  return true;
}

/// Looks for the densest precipitation that the strongest cut pays for, because that cut is not enough.
bool Search::thinOut() {
  const double farM = result_.visibilityM;
  const std::optional<double> none = frame(farM, 0);
  if (!none) return false;
  take(farM, 0, *none);
  if (!fits(*none)) {
    result_.outcome = CalibrationOutcome::fog_not_enough;
    return true;
  }
  result_.outcome = CalibrationOutcome::cut_not_enough;
  double low = 0, high = result_.presetDensity;
  for (int trial = 0; trial < settings_.mostTrials && high - low > settings_.densityStep; ++trial) {
    const double density = (low + high) / 2;
    const std::optional<double> ms = frame(farM, density);
    if (!ms) return false;
    if (fits(*ms)) take(farM, density, *ms);
    (fits(*ms) ? low : high) = density;
  }
  return true;
}

bool Search::isMonotone() const {
  // A far plane at the terrain's end removes nothing, so it takes as long as none, which was too long.
  const auto slowCut = [this](const CalibrationTrial& t) {
    return std::isfinite(t.farM) && t.ms > result_.clearMs;
  };
  if (result_.outcome == CalibrationOutcome::not_settled &&
      std::none_of(result_.trials.begin(), result_.trials.end(), slowCut))
    return false;
  std::vector<CalibrationTrial> sorted = result_.trials;
  std::stable_sort(sorted.begin(), sorted.end(), [](const CalibrationTrial& a, const CalibrationTrial& b) {
    return a.density != b.density ? a.density < b.density : a.farM < b.farM;
  });
  for (std::size_t i = 0; i < sorted.size(); ++i)
    for (std::size_t j = i + 1; j < sorted.size(); ++j)
      if (sorted[j].farM >= sorted[i].farM && sorted[j].ms < sorted[i].ms - tolerance()) return false;
  return true;
}

/// Measures the clear frame once more: what is measured between two different ones cannot be trusted.
void Search::lookAgain() {
  if (stopped_ || result_.outcome == CalibrationOutcome::not_a_number) return;
  const auto clear = clearFrame();
  if (!clear) return;
  result_.clearAfterMs = *clear;
  result_.drifted = !matches(*clear);
}

std::optional<StepCalibration> Search::ended() {
  if (stopped_) return std::nullopt;
  result_.notMonotone = !isMonotone();
  result_.nearFarRatio = parameters_.weather.defaultNear.value() / result_.farM;
  return result_;
}

std::optional<StepCalibration> Search::run() {
  const auto clear = clearFrame();
  if (!clear) return ended();
  result_.clearMs = *clear;
  const auto uncut = frame(WeatherDecision::kUnlimited, result_.presetDensity);
  if (!uncut) return ended();
  result_.uncutMs = result_.matchedMs = *uncut;
  const auto strongest = frame(result_.visibilityM, result_.presetDensity);
  if (!strongest) return ended();
  result_.strongestMs = *strongest;

  if (fits(*uncut))
    result_.outcome = CalibrationOutcome::costs_nothing;
  else if (matches(*strongest))
    take(result_.visibilityM, result_.presetDensity, *strongest);
  else if (fits(*strongest))
    static_cast<void>(pushOut());
  else
    static_cast<void>(thinOut());
  lookAgain();
  return ended();
}

/// Whole thousandths, as the rows show them.
double roundedDown(double value) {
  return std::floor(value * 1000 + 1e-9) / 1000;
}

}  // namespace

std::string_view toText(CalibrationOutcome outcome) {
  switch (outcome) {
    case CalibrationOutcome::matched:
      return "gain and loss match";
    case CalibrationOutcome::costs_nothing:
      return "costs less than the tolerance: nothing needs to be cut";
    case CalibrationOutcome::cut_not_enough:
      return "costs more than any cut can win: the density is what fits";
    case CalibrationOutcome::fog_not_enough:
      return "even without particles the strongest cut does not win back the cost";
    case CalibrationOutcome::not_settled:
      return "no far plane matched within the tolerance: the nearest match";
    case CalibrationOutcome::not_a_number:
      return "a measured time was no number";
  }
  return "";
}

std::optional<StepCalibration> calibrateStep(WeatherStep step, const TuningParameters& parameters,
                                             const MeasureFrame& measure,
                                             const CalibrationSettings& settings) {
  return Search(step, parameters, measure, settings).run();
}

std::string whyRejected(const StepCalibration& c) {
  if (c.outcome == CalibrationOutcome::not_a_number) return std::string(toText(c.outcome));
  if (!c.drifted) return c.notMonotone ? "the times contradict each other: measure more frames" : "";
  char text[120];
  std::snprintf(text, sizeof text,
                "the machine was busy, measure again: clear air took %.2f ms before and %.2f ms after",
                c.clearMs, c.clearAfterMs);
  return text;
}

void apply(const StepCalibration& calibration, TuningParameters& parameters) {
  WeatherStepParameters* step = stepParameters(parameters, calibration.step);
  if (step == nullptr || calibration.outcome == CalibrationOutcome::not_a_number) return;
  constexpr double kFarthestStretch = 1e5;
  parameters.weather.ratioMode = RatioMode::adaptive;
  step->farStretch = Ratio{std::clamp(roundedDown(calibration.farStretch()), 1.0, kFarthestStretch)};
  if (calibration.outcome == CalibrationOutcome::cut_not_enough ||
      calibration.outcome == CalibrationOutcome::fog_not_enough)
    step->density = Ratio{std::clamp(roundedDown(calibration.density), 0.0, 1.0)};
}

std::vector<RejectedStep> applyAccepted(std::span<const StepCalibration> results,
                                        TuningParameters& parameters) {
  std::vector<RejectedStep> rejected;
  for (const StepCalibration& result : results)
    if (std::string why = whyRejected(result); why.empty())
      apply(result, parameters);
    else
      rejected.push_back({result.step, std::move(why)});
  return rejected;
}

}  // namespace trimtab
