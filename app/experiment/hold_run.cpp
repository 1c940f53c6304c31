#include "hold_run.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "trimtab/preset/preset.h"
#include "trimtab/scene/data_extent.h"
#include "trimtab/scene/load_index.h"

namespace trimtab::experiment {
namespace {

constexpr double kImagesPerS = 60;
/// A display of 60 images a second holds each so long.
constexpr double kExposureMs = 16;
constexpr int kSweepImagesPerS = 200;
constexpr std::size_t kWarmUp = 60;
/// Images of a strain that show what levers lose; they lie between those that are measured afterwards.
constexpr std::size_t kLossImages = 5;

/// Returns the middle of the flight, from where on it is over the terrain for so long.
std::optional<double> middleOf(const Setup& setup, double seconds) {
  if (!setup.flight || setup.flight->states.empty()) return std::nullopt;
  const double begin = setup.flight->beginS(), end = setup.flight->states.back().time;
  const double from = std::max(begin, 0.5 * (begin + end) - 0.5 * seconds);
  const auto over = [&](double time) {
    return scene::liesOver(setup.terrain->info(), stateAt(*setup.flight, time).position);
  };
  if (from + seconds > end || !over(from) || !over(from + seconds)) return std::nullopt;
  return from;
}

template <class Change>
std::optional<Strain> flown(const Setup& setup, const char* name, double seconds, const Change& change) {
  const std::optional<double> from = middleOf(setup, seconds);
  if (!from) return std::nullopt;
  Strain strain{name, {}, kWarmUp, 0};
  const auto images = static_cast<std::size_t>(seconds * kImagesPerS);
  for (std::size_t i = 0; i < images; ++i) {
    const double time = static_cast<double>(i) / kImagesPerS;
    AircraftState state = stateAt(*setup.flight, *from + time);
    change(state, time);
    strain.states.push_back(state);
  }
  strain.to = images;
  return strain;
}

/// Turns the head as the log does `time` seconds after its begin.
void moveHead(const HeadLog& head, AircraftState& state, double time) {
  HeadInput input;
  input.useLog(head);
  input.begin(state.time - time);
  input.apply(state, state.time);
}

void fix(FrameRequest& request, const HeldLevers& levers) {
  request.levers.drawn = withBudget(request.levers.policy, levers);
}

}  // namespace

Strain sweepStrain(const GeodeticPosition& eye) {
  constexpr std::size_t kStill = 100, kSweep = 200, kRest = 200;
  Strain strain{"sweep of 180 degrees in 1 s", {}, kStill, kStill + kSweep};
  for (std::size_t i = 0; i < kStill + kSweep + kRest; ++i) {
    AircraftState state;
    state.time = static_cast<double>(i) / kSweepImagesPerS;
    state.packet = i;
    state.position = eye;
    const double part = (static_cast<double>(i) - kStill) / kSweep;
    state.head = Attitude{Degrees{180 * std::clamp(part, 0.0, 1.0)}, {}, {}};
    strain.states.push_back(state);
  }
  return strain;
}

std::optional<Strain> headStrain(const Setup& setup, const HeadLog& head, double seconds) {
  return flown(setup, "flight with a head log", seconds,
               [&](AircraftState& state, double time) { moveHead(head, state, time); });
}

std::optional<Strain> weatherStrain(const Setup& setup, const HeadLog& head, double seconds) {
  return flown(setup, "flight through weather", seconds, [&](AircraftState& state, double time) {
    moveHead(head, state, time);
    struct Phase {
      Precipitation falls;
      int severity;
    };
    constexpr std::array<Phase, 5> kPhases{{{Precipitation::none, 0},
                                            {Precipitation::rain, 1},
                                            {Precipitation::rain, 5},
                                            {Precipitation::snow, 5},
                                            {Precipitation::none, 0}}};
    const auto at = static_cast<std::size_t>(time / seconds * double(kPhases.size()));
    const Phase& phase = kPhases[std::min(at, kPhases.size() - 1)];
    state.weather = HostWeather{phase.falls, phase.severity, std::nullopt};
  });
}

std::optional<Strain> steadyStrain(const Setup& setup, double seconds) {
  return flown(setup, "steady flight", seconds, [](AircraftState&, double) {});
}

Result<ValidatedParameters> inMode(const TuningParameters& preset, HoldMode mode, double budgetMs) {
  TuningParameters p = preset;
  p.measure.budget = Milliseconds{budgetMs};
  p.weather.source = WeatherSource::host;
  p.hold.enabled = mode == HoldMode::hold;
  const bool published = mode == HoldMode::as_published;
  p.motion.control = published ? MotionControl::with_restoration : MotionControl::off;
  if (published) {
    p.motion.frames = MotionFrames::drawn;
    p.weather.precipitationForm = PrecipitationForm::effect;
  }
  p.weather.ratioMode = mode == HoldMode::off ? RatioMode::off : RatioMode::adaptive;
  if (mode == HoldMode::off || published) {
    p.policy.enabled = false;
  } else if (mode == HoldMode::policy && !p.policy.enabled) {
    const Result<Preset> searcher = loadPreset("helmet-search");
    if (!searcher) return searcher.findings();
    p.policy = searcher->parameters.policy;
  }
  return validate(p);
}

void measureLosses(scene::ErrorMeter& meter, const Setup& setup, const ValidatedParameters& asked,
                   const Strain& strain, HoldParameters& hold) {
  Session session(asked);
  session.setGround(setup.terrain);
  std::vector<double> error, scale, particles;
  for (std::size_t k = 0; k < kLossImages; ++k) {
    const AircraftState& state =
        strain.states[strain.from + (2 * k + 1) * (strain.to - strain.from) / (2 * kLossImages)];
    session.fly(state, state.time);
    const FrameRequest request = *session.request(state.time, setup.widthPx, setup.heightPx);
    const double whole = meter.measure(request, {}, nullptr).flip;
    const auto lost = [&](const HeldLevers& levers) {
      FrameRequest lowered = request;
      fix(lowered, levers);
      return meter.measure(lowered, {}, nullptr).flip - whole;
    };
    const HeldLevers full{request.levers.policy.errorPx, 1, 1, 1};
    error.push_back(lost({16, 1, 1, 1}));
    scale.push_back(lost({full.errorPx, 0.5, 1, 1}));
    if (request.decision.weather.density > 0) particles.push_back(lost({full.errorPx, 1, 0, 1}));
  }
  const auto loss = [](const std::vector<double>& flips) {
    return Ratio{std::clamp(meanOf(flips), 0.0, 1.0)};
  };
  hold.lossError = loss(error);
  hold.lossRenderScale = loss(scale);
  if (!particles.empty()) hold.lossParticles = loss(particles);
}

Result<std::unique_ptr<Referee>> Referee::open(const Setup& setup) {
  auto offscreen = scene::Offscreen::create(setup.widthPx, setup.heightPx);
  if (!offscreen) return offscreen.findings();
  std::unique_ptr<Referee> referee(new Referee);
  referee->offscreen_ = std::move(offscreen).value();
  if (const scene::GlReport gl = referee->meter().initialize(); !gl.usable)
    return Finding{Severity::error, "OpenGL", {}, "what the renderer needs", gl.missing};
  referee->meter_.setTerrain(setup.terrain);
  return {std::move(referee)};
}

Referee::~Referee() {
  meter().release();
}

scene::ErrorMeter& Referee::meter() {
  offscreen_->makeCurrent();
  return meter_;
}

HoldPilot::HoldPilot(Stage& stage, Referee& referee, const Setup& setup, const HoldFlight& flight,
                     const Strain& strain, const CostModel& model)
    : stage_(stage),
      referee_(referee),
      setup_(setup),
      flight_(flight),
      strain_(strain),
      session_(flight.parameters) {
  session_.setGround(setup.terrain);
  session_.setLoadIndex(scene::loadIndexOf(setup.terrain));
  session_.hold().model() = model;
}

void HoldPilot::drawNext() {
  const std::size_t i = next_++;
  const AircraftState& state = strain_.states[i];
  session_.fly(state, state.time);
  const auto start = std::chrono::steady_clock::now();
  FrameRequest request = *session_.request(state.time, setup_.widthPx, setup_.heightPx);
  lookMs_.push_back(
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
  if (flight_.fixed) fix(request, *flight_.fixed);
  const FrameResult result = stage_.fly(request);
  const FrameCost cost = session_.finished(result, state.time);
  session_.builtAhead(stage_.buildAhead(session_.nodesAhead(request), session_.aheadMs()).left);
  run_.ms.push_back(workMs(cost));
  const FrameLevers& drawn = request.levers.drawn;
  run_.errorPx.push_back(drawn.errorPx * drawn.lodScale);
  run_.renderScale.push_back(drawn.renderScale);
  run_.particles.push_back(drawn.particleShare);
  run_.limitMs.push_back(request.hold.limitMs);
  const bool strains = i >= strain_.from && i < strain_.to;
  if (const auto& outcome = session_.hold().outcome(); strains && outcome && flight_.parameters->hold.enabled)
    run_.outcomes.push_back(*outcome);
  measures_ = strains && flight_.flipEvery > 0 && (i - strain_.from) % flight_.flipEvery == 0;
  drawn_.push_back(request);
  if (drawn_.size() > kLongestTrace + 1) drawn_.erase(drawn_.begin());
}

void HoldPilot::measure() {
  if (!std::exchange(measures_, false)) return;
  const FrameRequest& request = drawn_.back();
  const std::size_t before = drawn_.size() - 1,
                    kept = blurs(request) ? before : std::min<std::size_t>(before, 1);
  run_.error.push_back(
      exposedError(referee_.meter(), request, std::span(drawn_).subspan(before - kept, kept), kExposureMs));
}

HoldRun HoldPilot::run() const {
  HoldRun run = run_;
  run.lookMs = quantileOf(lookMs_, 0.5);
  return run;
}

std::optional<std::vector<HoldRun>> flyInTurns(std::span<HoldPilot* const> pilots, const Strain& strain,
                                               const std::function<bool(double part)>& go) {
  for (std::size_t i = 0; i < strain.states.size(); ++i) {
    if (i % kAskedStates == 0 && !go(double(i) / double(strain.states.size()))) return std::nullopt;
    for (std::size_t k = 0; k < pilots.size(); ++k) pilots[(i + k) % pilots.size()]->drawNext();
    for (HoldPilot* const pilot : pilots) pilot->measure();
  }
  std::vector<HoldRun> runs;
  for (const HoldPilot* pilot : pilots) runs.push_back(pilot->run());
  return runs;
}

std::optional<HoldRun> fly(HoldPilot& pilot, const Strain& strain,
                           const std::function<bool(double part)>& go) {
  HoldPilot* const alone[] = {&pilot};
  auto runs = flyInTurns(alone, strain, go);
  return runs ? std::optional(std::move(runs->front())) : std::nullopt;
}

}  // namespace trimtab::experiment
