#include "trimtab/session/session.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <utility>

#include "core/session/on_ground.h"
#include "trimtab/decision/decide.h"
#include "trimtab/host/motion.h"
#include "trimtab/motion/line_of_sight.h"
#include "trimtab/policy/compiled_policy.h"
#include "trimtab/units/not_finite.h"
#include "trimtab/weather/weather.h"

namespace trimtab {
namespace {

/// A jump is shown for so many seconds.
constexpr double kJumpShownS = 1;

double millisecondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

/// A row of a trace has its signals, which depend on measured times: they are decided as they were.
bool replaysSignals(const FrameInput& input) {
  return std::any_of(input.signalValues.value.begin(), input.signalValues.value.end(),
                     [](double value) { return !std::isnan(value); });
}

}  // namespace

std::string_view toText(LinkState state) {
  constexpr std::string_view kNames[] = {"never", "live", "silent", "jumped"};
  const auto at = static_cast<std::size_t>(state);
  return at < std::size(kNames) ? kNames[at] : std::string_view{};
}

Session::Session(const ValidatedParameters& parameters) : parameters_(parameters) {}

void Session::setParameters(const ValidatedParameters& parameters) {
  parameters_ = parameters;
  dirty_ = true;
  signals_.tracker.imageChanged();
  memory_.levers.restart();
  lookMemory_.levers.restart();
  air_.fade.settle();
  if (!current_) return;
  decided_.aboveGround = groundBelow(decided_.state);
  decided_.highestGround = highestGround();
  DecisionMemory copy = looking_ ? lookMemory_ : memory_;
  // The head's memory is that of before the state was decided: no time passes in an edit, and a head would
  // seem to rest.
  copy.motion = motionBefore_;
  decideInput(copy);
}

void Session::setGround(std::shared_ptr<const GroundHeights> ground) {
  ground_ = std::move(ground);
  dirty_ = true;
  signals_.tracker.imageChanged();
}

/// States no longer come from a live link.
void Session::unlink() {
  linked_ = false;
  hostSymbols_.reset();
}

void Session::receive(std::span<const ReceivedState> states) {
  for (const ReceivedState& received : states) {
    latency_.decoded(received.kernelTime, received.decodedTime);
    AircraftState state = onGround(received.state, ground_.get());
    head_.apply(state, received.kernelTime);
    follow(state, received.kernelTime);
    hostSymbols_ = received.symbols;
    if (decidesImages())
      arrive(state, received.kernelTime);
    else
      decideNext(inputFor(state), received.kernelTime);
  }
}

void Session::fly(const AircraftState& state, double now) {
  unlink();
  AircraftState flown = onGround(state, ground_.get());
  head_.apply(flown, now);
  decideNext(inputFor(flown), kNan);
}

void Session::replay(const TraceRow& row) {
  unlink();
  if (!replayed_) memory_ = row.before;
  replayed_ = true;
  budget_.replayed = row.hold;
  FrameInput input = row.input;
  if (!input.aboveGround && row.decision.reason != SchemeReason::altitude_unknown)
    input.aboveGround = groundBelow(input.state);
  decideNext(input, kNan);
}

void Session::look(const AircraftState& state) {
  if (!looking_ || isJump(current_->state.position, state.position, state.time - current_->state.time, false))
    lookMemory_ = {}, groundVelocity_.restart(), signals_.tracker.restart();
  const bool stands = looking_ && state.position == current_->state.position;
  looking_ = true;
  unlink();
  AircraftState seen = state;
  head_.apply(seen, state.time);
  // A camera that stands is looked at once more, and then no more.
  if (stands) seen.velocity = Velocity{};
  groundVelocity_.push(seen);
  decided_ = inputFor(seen);
  decideWith(lookMemory_);
  current_ = decided_;
  dirty_ = true;
}

void Session::restart() {
  Session fresh(parameters_);
  fresh.ground_ = std::move(ground_);
  fresh.head_ = std::move(head_);
  fresh.head_.restart();
  fresh.budget_.hold = std::move(budget_.hold);
  fresh.budget_.hold.setMemory({});
  fresh.signals_.watched = signals_.watched;
  fresh.keepRows_ = keepRows_;
  fresh.rows_ = std::move(rows_);
  fresh.completeRows_ = fresh.requestedRows_ = fresh.rows_.size();
  fresh.dirty_ = true;
  *this = std::move(fresh);
}

/// Returns the height above the terrain that is drawn, but only if the decision wants it: it costs a look-up.
/// Where the terrain knows nothing, what the host sent is all there is.
std::optional<Metres> Session::groundBelow(const AircraftState& state) const {
  const CompiledPolicy* const policy = parameters_.policy();
  const bool asked = parameters_->altitude.reference == AltitudeReference::above_ground ||
                     (policy != nullptr && policy->asks(Signal::above_ground));
  const std::optional<Metres> height = asked ? heightOverTerrain(state) : std::nullopt;
  return height ? height : state.aboveGround;
}

/// Notes where the host's height above ground is not the terrain's.
void Session::compareGround(const AircraftState& state, std::optional<Metres> overTerrain) {
  if (!state.aboveGround || !overTerrain) return;
  const Metres host = *state.aboveGround;
  // Hosts send it as a float.
  const double rounding = 1e-6 * std::abs(state.position.height.value());
  const bool isAltitude = std::abs((host - state.position.height).value()) <= rounding;
  const Metres bound = isAltitude ? GroundDoubt::kNoSea : GroundDoubt::kTooFar;
  if (std::abs((host - *overTerrain).value()) < bound.value()) return;
  doubt_ = GroundDoubt{doubt_ ? doubt_->states + 1 : 1, host, *overTerrain, isAltitude};
}

std::optional<Metres> Session::heightOverTerrain(const AircraftState& state) const {
  const std::optional<Metres> ground =
      ground_ ? ground_->heightAt(state.position.latitude, state.position.longitude) : std::nullopt;
  return ground ? std::optional(state.position.height - *ground) : std::nullopt;
}

/// Returns it only if the decision wants it, so that traces of other presets do not depend on the terrain.
std::optional<Metres> Session::highestGround() const {
  if (parameters_->weather.air != AirModel::layer || !ground_) return std::nullopt;
  return ground_->highest();
}

FrameInput Session::inputFor(const AircraftState& state) const {
  FrameInput input{state, groundBelow(state), lastCost_, {}, {}, highestGround()};
  // The rows of a flight are its images whatever the clock says, so that they are decided alike anywhere.
  if (parameters_->motion.frames == MotionFrames::drawn) {
    input.drawn.vertices = lastVertices_;
    if (linked_ || looking_) input.drawn.framesPerS = imageRate_.perS();
  }
  return input;
}

/// Derives the signals, if there is a policy or somebody watches, from the state that is about to be decided.
void Session::trackSignals(FrameInput& input, const WeatherDecision& weather) {
  std::optional<SignalValues>& watched = signals_.watched;
  if (!replaysSignals(input)) {
    if (parameters_.policy() == nullptr && !watched) return;
    // Whoever watches sees the height before a rule asks for it.
    std::optional<Metres> height = input.aboveGround;
    if (watched)
      if (const auto overTerrain = heightOverTerrain(input.state)) {
        compareGround(input.state, overTerrain);
        height = overTerrain;
      }
    signals_.tracker.push(input.state, height, velocityOf(input.state), weather);
    if (parameters_.policy() != nullptr) input.signalValues = signals_.tracker.values();
  }
  if (watched) watched = replaysSignals(input) ? input.signalValues : signals_.tracker.values();
}

/// Link bookkeeping of one packet: clock, silence, jumps, velocity.
void Session::follow(const AircraftState& state, double arrival) {
  const bool first = packets_ == 0 || !linked_;
  if (first) hostClock_.restart();
  hostClock_.follow(state.time, arrival);
  if (!first && current_) {
    const double gap = std::max(arrival - lastArrival_, 0.0);
    if (isJump(current_->state.position, state.position, gap, gap > kSilenceS)) {
      ++jumps_;
      lastJump_ = arrival;
    }
  }
  linked_ = true;
  lastArrival_ = arrival;
  extrapolator_.push(state);
}

void Session::decideNext(FrameInput input, double kernelTime) {
  const bool looking = std::exchange(looking_, false);
  ++packets_;
  if (looking) signals_.tracker.restart();
  decided_ = std::move(input);
  if (!signals_.watched) compareGround(decided_.state, decided_.aboveGround);
  decideWith(memory_);
  if (looking) groundVelocity_.restart();
  groundVelocity_.push(decided_.state);
  current_ = decided_;
  dirty_ = true;
  latency_.arrived(kernelTime);
}

void Session::decideInput(DecisionMemory& memory) {
  const WeatherDecision weather = decideWeather(decided_.state, *parameters_, decided_.highestGround);
  trackSignals(decided_, weather);
  decision_ = decide(decided_, weather, parameters_, memory);
  // The decision itself finds these two; traces and panels show them with the others.
  const bool known =
      decision_.reason != SchemeReason::invalid_input && decision_.reason != SchemeReason::altitude_unknown;
  const auto complete = [&](SignalValues& values) {
    values[Signal::altitude_membership] = known ? decision_.altitudeMembership : kNan;
    values[Signal::pitch_membership] = known ? decision_.pitchMembership : kNan;
  };
  if (parameters_.policy() != nullptr) complete(decided_.signalValues);
  if (signals_.watched) complete(*signals_.watched);
}

/// Decides `decided_`, with a row of the trace unless it is a free camera's.
void Session::decideWith(DecisionMemory& memory) {
  const DecisionMemory before = memory;
  const auto start = std::chrono::steady_clock::now();
  decideInput(memory);
  decideMs_ += millisecondsSince(start);
  motionBefore_ = before.motion;
  blurPicturedAt_.reset();
  if (keepRows_ && !looking_)
    rows_.push_back({decided_, before, decision_, leversOf(decision_, *parameters_)});
}

/// Reports whether an image's own state is decided instead of each state that arrives.
bool Session::decidesImages() const {
  return linked_ && parameters_->motion.control != MotionControl::off &&
         parameters_->motion.frames == MotionFrames::drawn;
}

/// Moves the eye on to a state without deciding it.
void Session::arrive(const AircraftState& state, double kernelTime) {
  if (std::exchange(looking_, false)) groundVelocity_.restart();
  const bool first = packets_++ == 0;
  groundVelocity_.push(state);
  current_ = inputFor(state);
  if (first) decided_ = *current_;
  dirty_ = true;
  latency_.arrived(kernelTime);
}

/// Decides the newest state once more for the image at `now`, whose turn head motion counts. All else is
/// decided from the state, never from an eye between two states. The image's time goes on even where the eye
/// stands, so that an image of a head that rests is a slow frame.
void Session::decideImage(double now) {
  const AircraftState eye = eyeState(now);
  decided_ = inputFor(current_->state);
  decided_.drawn.eye = DrawnEye{hostClock_.hostTime(now), eye.position, eye.attitude, eye.head};
  decideWith(memory_);
}

LinkState Session::linkState(double now) const {
  if (lastArrival_ == 0) return LinkState::never;
  if (now - lastArrival_ > parameters_->host.silenceAfter.in<Seconds>()) return LinkState::silent;
  if (jumps_ > 0 && now - lastJump_ < kJumpShownS) return LinkState::jumped;
  return LinkState::live;
}

double Session::packetAge(double now) const {
  return lastArrival_ == 0 ? kNan : now - lastArrival_;
}

AircraftState Session::eyeState(double now) const {
  AircraftState eye = current_->state;
  if (const std::optional<DrawnEye>& drawn = current_->drawn.eye) {  // a row of a trace
    eye.time = drawn->timeS;
    eye.position = drawn->position;
    eye.attitude = drawn->attitude;
    eye.head = drawn->head;
  }
  if (linked_ && parameters_->host.extrapolate) {
    eye = extrapolator_.at(hostClock_.hostTime(now), parameters_->host.silenceAfter.in<Seconds>());
    eye.view = current_->state.view;
  }
  head_.applyToEye(eye);
  return eye;
}

void Session::keepRows(bool keep) {
  keepRows_ = keep;
}

void Session::takeRows(std::vector<TraceRow>& rows, bool all) {
  if (all) completeRows_ = requestedRows_ = rows_.size();
  const auto end = rows_.begin() + static_cast<std::ptrdiff_t>(completeRows_);
  rows.insert(rows.end(), std::make_move_iterator(rows_.begin()), std::make_move_iterator(end));
  rows_.erase(rows_.begin(), end);
  requestedRows_ -= completeRows_;
  completeRows_ = 0;
}

}  // namespace trimtab
