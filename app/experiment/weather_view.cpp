#include "weather_view.h"

#include <algorithm>
#include <cmath>

#include "trimtab/decision/decide.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/scene/load_index.h"
#include "trimtab/session/session.h"

namespace trimtab::experiment {
namespace {

/// Particles fall as time goes on: frames are this far apart.
constexpr double kFrameS = 1.0 / 60;
/// So many frames do not count: what was just built, compiled or grown, or drawn by another renderer, is no
/// frame's cost.
constexpr int kUncounted = 3;
/// Clear and held frames are drawn in turns of so many frames that count. In the first turns of a cell the
/// arbiter settles on what falls now, and the others are compared.
constexpr int kTurn = 9, kSettlingTurns = 10, kTurns = 6;
/// Before the first cell the arbiter is given less and then more of the clear frame's time in heavy rain, so
/// that it knows what the levers are worth, as after a flight.
constexpr int kLearningTurns = 12;
/// The clear frame's time is the median of the last turns, because the machine's speed changes.
constexpr int kRemembered = 3 * kTurn;
/// So many pairs have an interval that leaves out the largest and the smallest ratio.
constexpr std::size_t kTurnsOfEach = 9;

}  // namespace

Result<std::unique_ptr<WeatherView>> WeatherView::open(const Setup& setup) {
  std::unique_ptr<WeatherView> view(new WeatherView);
  view->preset_ = setup.parameters;
  view->preset_.motion.control = MotionControl::off;
  const Result<ValidatedParameters> parameters = validate(view->preset_);
  if (!parameters) return parameters.findings();
  for (std::unique_ptr<Stage>* place : {&view->stage_, &view->heldStage_}) {
    auto stage = Stage::open(setup);
    if (!stage) return stage.findings();
    *place = std::move(*stage);
  }
  const std::vector<Place> places = placesOf(setup, 1);
  if (places.empty()) return notOverTerrain(setup);
  view->repeats_ = setup.repeats;

  const Place& place = places[0];
  AircraftState state;
  state.position = place.ground;
  state.position.height = place.ground.height + Feet{kEyeFt}.as<Metres>();
  state.attitude = place.attitude;
  Session session(*parameters);
  session.setGround(setup.terrain);
  session.look(state);
  view->request_ = *session.request(0, setup.widthPx, setup.heightPx);
  // The view sets the error itself.
  view->request_.decision.policy.moved &= ~(1u << indexOf(Lever::screen_space_error));
  view->setWeather({});
  view->hold_.setIndex(scene::loadIndexOf(setup.terrain));
  return view;
}

void WeatherView::setError(double px) {
  preset_.lod.screenSpaceError = preset_.staticLod.errorPx = Pixels{px};
  setWeather(request_.decision.weather);
}

void WeatherView::setWeather(const WeatherDecision& weather) {
  request_.decision.weather = weather;
  request_.levers = leversIn(weather, request_.decision, preset_);
}

double WeatherView::vertices() {
  setWeather({});
  return double(stage_->draw(request_).visible.vertices);
}

/// Halves the interval, because vertices fall as the error grows.
double WeatherView::reach(double vertices, double& reached) {
  double fine = std::log(0.05), coarse = std::log(64.0), error = 0;
  for (int i = 0; i < 24; ++i) {
    error = std::exp((fine + coarse) / 2);
    setError(error);
    reached = this->vertices();
    if (std::abs(reached / vertices - 1) < kWithin / 10) break;
    (reached > vertices ? fine : coarse) = std::log(error);
  }
  return error;
}

std::vector<double> WeatherView::drawn(const WeatherDecision& weather, int frames) {
  setWeather(weather);
  std::vector<double> ms;
  for (int i = 0; i < kUncounted + frames; ++i) {
    request_.time += kFrameS;
    const double work = workMs(stage_->draw(request_).cost);
    if (i >= kUncounted) ms.push_back(work);
  }
  return ms;
}

double WeatherView::ms(const WeatherDecision& weather) {
  return quantileOf(drawn(weather, repeats_), 0.5);
}

std::vector<std::vector<double>> WeatherView::inTurns(std::span<const WeatherDecision> weathers) {
  std::vector<std::vector<double>> medians(weathers.size());
  for (std::size_t turn = 0; turn < kTurnsOfEach; ++turn)
    for (std::size_t i = 0; i < weathers.size(); ++i) {
      const std::size_t which = (turn + i) % weathers.size();
      medians[which].push_back(ms(weathers[which]));
    }
  return medians;
}

WeatherView::Held WeatherView::held(const WeatherDecision& weather, double overClear) {
  HoldParameters parameters = preset_.hold;
  parameters.enabled = true;
  // Document D compares medians, so the median is what is held.
  parameters.margin = parameters.caution = Ratio{0};
  hold_.setMemory({});
  std::vector<double> clearMs, heldMs;
  Held held;
  const auto turn = [&](double part, const WeatherDecision& falling) {
    const std::vector<double> clear = drawn({}, kTurn);
    clearMs.insert(clearMs.end(), clear.begin(), clear.end());
    const auto last = clearMs.end() - std::min<std::ptrdiff_t>(std::ssize(clearMs), kRemembered);
    const double budgetMs = part * overClear * quantileOf({last, clearMs.end()}, 0.5);
    for (int i = 0; i < kUncounted + kTurn; ++i) {
      request_.time += kFrameS;
      setWeather(falling);
      FrameRequest request = request_;
      const HoldGiven given = hold_.look(request, {}, budgetMs);
      const HoldDecision decision = hold_.decide(given, parameters, request);
      held.levers = decision.held, held.reason = decision.reason;
      const FrameResult result = heldStage_->draw(request);
      hold_.finished(result, result.cost);
      if (i >= kUncounted) heldMs.push_back(workMs(result.cost));
    }
  };
  if (hold_.model().images() == 0) {
    const WeatherDecision rain = weatherOf(preset_, WeatherStep::rain_heavy, RatioMode::off);
    for (int i = 0; i < kLearningTurns; ++i)
      turn(0.5 + 0.5 * std::abs(i - kLearningTurns / 2) / (kLearningTurns / 2), rain);
    hold_.setMemory({});
  }
  for (int i = 0; i < kSettlingTurns; ++i) turn(1, weather);
  const std::ptrdiff_t compared = kTurns * kTurn;
  for (int i = 0; i < kTurns; ++i) turn(1, weather);
  clearMs.erase(clearMs.begin(), clearMs.end() - compared);
  heldMs.erase(heldMs.begin(), heldMs.end() - compared);
  held.ofClear = pairedRatio(clearMs, heldMs);
  return held;
}

scene::CutError WeatherView::cutError(const WeatherDecision& weather) {
  setWeather(weather);
  return stage_->cutError(request_);
}

std::optional<StepCalibration> calibrateOn(WeatherView& view, const Setup& setup,
                                           const TuningParameters& parameters, WeatherStep step,
                                           int mostTrials, const std::function<bool()>& go) {
  CalibrationSettings settings;
  settings.tolerance = parameters.weather.tolerance.value();
  settings.repeats = 1;  // a view's measurement is a median already
  settings.mostTrials = mostTrials;
  settings.farthestM = farthestM(setup);
  return calibrateStep(
      step, parameters,
      [&](const WeatherDecision& weather) -> std::optional<double> {
        if (!go()) return std::nullopt;
        return view.ms(weather);
      },
      settings);
}

bool costsTooMuch(const StepCalibration& found) {
  return found.outcome == CalibrationOutcome::cut_not_enough ||
         found.outcome == CalibrationOutcome::fog_not_enough;
}

TuningParameters tunedBy(const StepCalibration& found, const TuningParameters& parameters) {
  TuningParameters tuned = parameters;
  if (costsTooMuch(found))
    stepParameters(tuned, found.step)->farStretch = Ratio{1};
  else
    apply(found, tuned);
  return tuned;
}

double farthestM(const Setup& setup) {
  const terrain::TerrainInfo& info = setup.terrain->info();
  return length(toEcef(info.northEast) - toEcef(info.southWest));
}

WeatherDecision weatherOf(const TuningParameters& parameters, WeatherStep step, RatioMode mode) {
  TuningParameters changed = parameters;
  changed.weather.source = WeatherSource::preset;
  changed.weather.step = step;
  changed.weather.ratioMode = mode;
  return decideWeather({}, changed);
}

bool isOneSetting(const WeatherDecision& a, const WeatherDecision& b) {
  return (a.farM == b.farM || std::abs(a.farM - b.farM) < 1e-3) && a.density == b.density;
}

}  // namespace trimtab::experiment
