#include "trimtab/session/decider.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "trimtab/policy/compiled_policy.h"
#include "trimtab/units/not_finite.h"
#include "trimtab/weather/weather.h"

namespace trimtab {
namespace {

/// A row of a trace has its signals, which depend on measured times: they are decided as they were.
bool replaysSignals(const FrameInput& input) {
  return std::any_of(input.signalValues.value.begin(), input.signalValues.value.end(),
                     [](double value) { return !std::isnan(value); });
}

}  // namespace

void Decider::setParameters(const ValidatedParameters& parameters) {
  parameters_ = parameters;
  tracker_.imageChanged();
  memory_.levers.restart();
  lookMemory_.levers.restart();
}

void Decider::setGround(std::shared_ptr<const GroundHeights> ground) {
  ground_ = std::move(ground);
  tracker_.imageChanged();
}

void Decider::restart() {
  Decider fresh(parameters_);
  fresh.ground_ = std::move(ground_);
  fresh.watched_ = watched_;
  *this = std::move(fresh);
}

/// Looks up the terrain only if the decision wants it: that costs time.
std::optional<Metres> Decider::groundBelow(const AircraftState& state) const {
  const CompiledPolicy* const policy = parameters_.policy();
  const bool asked = parameters_->altitude.reference == AltitudeReference::above_ground ||
                     (policy != nullptr && policy->asks(Signal::above_ground));
  const std::optional<Metres> height = asked ? heightOverTerrain(state) : std::nullopt;
  return height ? height : state.aboveGround;
}

/// Notes where the host's height above ground is not the terrain's.
void Decider::compareGround(std::optional<Metres> overTerrain) {
  const AircraftState& state = input_.state;
  if (!state.aboveGround || !overTerrain) return;
  const Metres host = *state.aboveGround;
  // Hosts send it as a float.
  const double rounding = 1e-6 * std::abs(state.position.height.value());
  const bool isAltitude = std::abs((host - state.position.height).value()) <= rounding;
  const Metres bound = isAltitude ? GroundDoubt::kNoSea : GroundDoubt::kTooFar;
  if (std::abs((host - *overTerrain).value()) < bound.value()) return;
  doubt_ = GroundDoubt{doubt_ ? doubt_->states + 1 : 1, host, *overTerrain, isAltitude};
}

std::optional<Metres> Decider::heightOverTerrain(const AircraftState& state) const {
  const std::optional<Metres> ground =
      ground_ ? ground_->heightAt(state.position.latitude, state.position.longitude) : std::nullopt;
  return ground ? std::optional(state.position.height - *ground) : std::nullopt;
}

/// Asks only if the decision wants it, so that traces of other presets do not depend on the terrain.
std::optional<Metres> Decider::highestGround() const {
  if (parameters_->weather.air != AirModel::layer || !ground_) return std::nullopt;
  return ground_->highest();
}

FrameInput Decider::inputFor(const AircraftState& state) const {
  FrameInput input;
  input.state = state;
  input.aboveGround = groundBelow(state);
  input.highestGround = highestGround();
  return input;
}

std::optional<Velocity> Decider::velocityOf(const AircraftState& state) const {
  return state.velocity ? state.velocity : groundVelocity_.velocity();
}

/// Derives the signals, if there is a policy or somebody watches, from the state that is about to be decided.
void Decider::trackSignals(const WeatherDecision& weather) {
  if (!replaysSignals(input_)) {
    if (parameters_.policy() == nullptr && !watched_) return;
    // Whoever watches sees the height before a rule asks for it.
    std::optional<Metres> height = input_.aboveGround;
    if (watched_)
      if (const auto overTerrain = heightOverTerrain(input_.state)) {
        compareGround(overTerrain);
        height = overTerrain;
      }
    tracker_.push(input_.state, height, velocityOf(input_.state), weather);
    if (parameters_.policy() != nullptr) input_.signalValues = tracker_.values();
  }
  if (watched_) watched_ = replaysSignals(input_) ? input_.signalValues : tracker_.values();
}

void Decider::decideInput(DecisionMemory& memory) {
  const WeatherDecision weather = decideWeather(input_.state, *parameters_, input_.highestGround);
  trackSignals(weather);
  decision_ = decide(input_, weather, parameters_, memory);
  // The decision itself finds these two; traces and panels show them with the others.
  const bool known =
      decision_.reason != SchemeReason::invalid_input && decision_.reason != SchemeReason::altitude_unknown;
  const auto complete = [&](SignalValues& values) {
    values[Signal::altitude_membership] = known ? decision_.altitudeMembership : kNan;
    values[Signal::pitch_membership] = known ? decision_.pitchMembership : kNan;
  };
  if (parameters_.policy() != nullptr) complete(input_.signalValues);
  if (watched_) complete(*watched_);
}

DecisionMemory Decider::decideWith(DecisionMemory& memory) {
  const DecisionMemory before = memory;
  decideInput(memory);
  motionBefore_ = before.motion;
  return before;
}

DecisionMemory Decider::next(FrameInput input) {
  const bool looked = std::exchange(looking_, false);
  if (looked) tracker_.restart();
  input_ = std::move(input);
  if (!watched_) compareGround(input_.aboveGround);
  const DecisionMemory before = decideWith(memory_);
  if (looked) groundVelocity_.restart();
  groundVelocity_.push(input_.state);
  return before;
}

DecisionMemory Decider::forImage(FrameInput input) {
  input_ = std::move(input);
  return decideWith(memory_);
}

void Decider::arrive(const AircraftState& state) {
  if (std::exchange(looking_, false)) groundVelocity_.restart();
  groundVelocity_.push(state);
}

void Decider::look(FrameInput input, bool anew) {
  if (anew) lookMemory_ = {}, groundVelocity_.restart(), tracker_.restart();
  looking_ = true;
  groundVelocity_.push(input.state);
  input_ = std::move(input);
  decideWith(lookMemory_);
}

void Decider::again() {
  input_.aboveGround = groundBelow(input_.state);
  input_.highestGround = highestGround();
  DecisionMemory copy = looking_ ? lookMemory_ : memory_;
  copy.motion = motionBefore_;
  decideInput(copy);
}

}  // namespace trimtab
