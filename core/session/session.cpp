#include "trimtab/session/session.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "core/session/on_ground.h"
#include "trimtab/host/motion.h"
#include "trimtab/units/not_finite.h"

namespace trimtab {

void Session::setParameters(const ValidatedParameters& parameters) {
  decider_.setParameters(parameters);
  flight_.maker.edited();
  if (flight_.current) decider_.again();
  dirty_ = true;
}

void Session::setGround(std::shared_ptr<const GroundHeights> ground) {
  decider_.setGround(std::move(ground));
  dirty_ = true;
}

void Session::receive(std::span<const ReceivedState> states) {
  for (const ReceivedState& received : states) {
    book_.packetDecoded(received.kernelTime, received.decodedTime);
    AircraftState state = onGround(received.state, decider_.ground());
    head_.apply(state, received.kernelTime);
    flight_.link.follow(state, received.kernelTime, flight_.current ? &flight_.current->state : nullptr);
    flight_.link.setSymbols(received.symbols);
    if (decidesImages())
      arrive(state, received.kernelTime);
    else
      decideNext(inputFor(state, true), received.kernelTime);
  }
}

void Session::fly(const AircraftState& state, double now) {
  flight_.link.leave();
  AircraftState flown = onGround(state, decider_.ground());
  head_.apply(flown, now);
  decideNext(inputFor(flown, false), kNan);
}

void Session::replay(const TraceRow& row) {
  flight_.link.leave();
  if (!std::exchange(flight_.replayed, true)) decider_.resume(row.before);
  flight_.replayedHold = row.hold;
  FrameInput input = row.input;
  if (!input.aboveGround && row.decision.reason != SchemeReason::altitude_unknown)
    input.aboveGround = decider_.groundBelow(input.state);
  decideNext(std::move(input), kNan);
}

void Session::look(const AircraftState& state) {
  flight_.link.leave();
  AircraftState seen = state;
  bool anew = true;
  if (decider_.looking()) {
    const AircraftState& before = flight_.current->state;
    anew = isJump(before.position, state.position, state.time - before.time, false);
    // A camera that stands is looked at once more, and then no more.
    if (state.position == before.position) seen.velocity = Velocity{};
  }
  head_.apply(seen, state.time);
  timed([&] { decider_.look(inputFor(seen, true), anew); });
  flight_.current = decider_.input();
  dirty_ = true;
}

void Session::restart() {
  decider_.restart();
  head_.restart();
  book_.restart();
  hold_.setMemory({});
  flight_ = {};
  dirty_ = true;
}

/// `live`: images are drawn as the clock goes. The rows of a flight are its images whatever the clock says,
/// so that they are decided alike anywhere.
FrameInput Session::inputFor(const AircraftState& state, bool live) const {
  FrameInput input = decider_.inputFor(state);
  input.lastCost = book_.lastCost();
  if (parameters()->motion.frames == MotionFrames::drawn) {
    input.drawn.vertices = book_.lastVertices();
    if (live) input.drawn.framesPerS = flight_.imageRate.perS();
  }
  return input;
}

/// Runs `decide`, whose time is part of the next image's cost.
template <class Decide>
void Session::timed(const Decide& decide) {
  const auto start = std::chrono::steady_clock::now();
  decide();
  book_.decisionTook(
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
  flight_.maker.decided();
}

void Session::addRow(const DecisionMemory& before) {
  if (book_.keepsRows())
    book_.add({decider_.input(), before, decider_.decision(), leversOf(decider_.decision(), *parameters())});
}

void Session::decideNext(FrameInput input, double kernelTime) {
  ++flight_.packets;
  timed([&] { addRow(decider_.next(std::move(input))); });
  flight_.current = decider_.input();
  dirty_ = true;
  book_.packetArrived(kernelTime);
}

/// Reports whether an image's own state is decided instead of each state that arrives.
bool Session::decidesImages() const {
  return flight_.link.connected() && parameters()->motion.control != MotionControl::off &&
         parameters()->motion.frames == MotionFrames::drawn;
}

/// Moves the eye on to a state without deciding it.
void Session::arrive(const AircraftState& state, double kernelTime) {
  decider_.arrive(state);
  flight_.current = inputFor(state, true);
  if (flight_.packets++ == 0) decider_.setInput(*flight_.current);
  dirty_ = true;
  book_.packetArrived(kernelTime);
}

/// Decides the newest state once more for the image at `now`, whose turn head motion counts. All else is
/// decided from the state, never from an eye between two states. The image's time goes on even where the eye
/// stands, so that an image of a head that rests is a slow frame.
void Session::decideImage(double now) {
  const AircraftState eye = eyeState(now);
  FrameInput input = inputFor(flight_.current->state, true);
  input.drawn.eye = DrawnEye{flight_.link.hostTime(now), eye.position, eye.attitude, eye.head};
  timed([&] { addRow(decider_.forImage(std::move(input))); });
}

AircraftState Session::eyeState(double now) const {
  const FrameInput& current = *flight_.current;
  AircraftState eye = current.state;
  if (const std::optional<DrawnEye>& drawn = current.drawn.eye) {  // a row of a trace
    eye.time = drawn->timeS;
    eye.position = drawn->position;
    eye.attitude = drawn->attitude;
    eye.head = drawn->head;
  }
  if (flight_.link.connected() && parameters()->host.extrapolate) {
    eye = flight_.link.aircraftAt(now, parameters()->host.silenceAfter);
    eye.view = current.state.view;
  }
  head_.applyToEye(eye);
  return eye;
}

bool Session::unsettled() const {
  if (flight_.blurDrawn) return true;
  if (!decidesImages()) return false;
  // An image that does not differ is a slow frame: it empties BlurStack and fills LODRestoreStack.
  const MotionMemory& motion = decider_.memory().motion;
  const bool restores = parameters()->motion.control == MotionControl::with_restoration;
  return motion.blurStack.frames > 0 || (restores && motion.level > 0);
}

bool Session::needsImage(double now) const {
  if (!flight_.current) return false;
  if (dirty_ || unsettled()) return true;
  const bool moving = flight_.link.connected() || head_.source() == HeadInput::Source::pointer;
  return moving && flight_.maker.differs(eyeState(now), flight_.link.symbols().get(), *parameters());
}

std::optional<FrameRequest> Session::request(double now, int windowWidthPx, int windowHeightPx, ViewFit fit) {
  if (!flight_.current) return std::nullopt;
  flight_.imageRate.add(now);
  if (decidesImages()) decideImage(now);
  const AircraftState eye = eyeState(now);
  const ImageOf image{eye, decider_.velocityOf(eye), decider_.decision(), flight_.link.symbols()};
  FrameRequest request = flight_.maker.make(image, *parameters(), now, {windowWidthPx, windowHeightPx, fit});
  holdBudget(request);
  flight_.blurDrawn = request.levers.drawn.blurStrength > 0;
  if (TraceRow* row = book_.nextRow()) row->levers = request.levers;
  book_.requested(now);
  dirty_ = false;
  return request;
}

/// Runs the chain's last step: lowers the levers of a request until its predicted time fits the budget, if
/// the preset asks for that. What was decided for a row of a trace is applied as it is.
void Session::holdBudget(FrameRequest& request) {
  const HoldParameters& p = parameters()->hold;
  const std::optional<HoldDecision> replayed = std::exchange(flight_.replayedHold, std::nullopt);
  flight_.ahead.push(request.time, {request.eye, request.attitude});
  if (!p.enabled) return;
  const auto images = static_cast<std::size_t>(p.lookAhead.value());
  const HoldGiven given =
      hold_.look(request, flight_.ahead.coming(images), parameters()->measure.budget.value());
  const HoldDecision decision =
      replayed ? hold_.replay(given, *replayed, request) : hold_.decide(given, p, request);
  if (TraceRow* row = book_.nextRow()) row->hold = decision;
}

std::span<const std::uint32_t> Session::nodesAhead(const FrameRequest& drawn) {
  const auto images = static_cast<std::size_t>(parameters()->hold.lookAhead.value());
  return hold_.nodesAhead(drawn, flight_.ahead.coming(images));
}

double Session::aheadMs() const {
  const double budget = parameters()->measure.budget.value();
  return std::max((budget - workMs(book_.lastCost())) / 2, budget / 50);
}

FrameCost Session::finished(const FrameResult& result, double now) {
  const double budgetMs = parameters()->measure.budget.value();
  book_.finished(result, now, budgetMs);
  const FrameCost& cost = book_.lastCost();
  if (parameters()->hold.enabled) hold_.finished(result, cost);
  decider_.signalTracker().finished(cost.total, budgetMs, result.visible.triangles);
  return cost;
}

void Session::noPicture() {
  if (decidesImages()) decideImage(flight_.link.lastArrival());
  book_.dropped();
}

}  // namespace trimtab
