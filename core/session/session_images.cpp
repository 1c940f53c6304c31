#include <algorithm>
#include <cmath>
#include <utility>

#include "trimtab/decision/decide.h"
#include "trimtab/motion/line_of_sight.h"
#include "trimtab/session/session.h"
#include "trimtab/units/not_finite.h"
#include "trimtab/weather/weather.h"

/// Implements what a session says of images: when one is due, what it asks for, and what it cost.
namespace trimtab {
namespace {

bool samePose(const AircraftState& a, const AircraftState& b) {
  return a.position == b.position && a.attitude == b.attitude && a.head == b.head && a.view == b.view;
}

}  // namespace

bool Session::unsettled() const {
  if (blurDrawn_) return true;
  if (!decidesImages()) return false;
  // An image that does not differ is a slow frame: it empties BlurStack and fills LODRestoreStack.
  const bool restores = parameters_->motion.control == MotionControl::with_restoration;
  return memory_.motion.blurStack.frames > 0 || (restores && memory_.motion.level > 0);
}

bool Session::needsImage(double now) const {
  if (!current_) return false;
  if (dirty_ || unsettled() || !drawnEye_) return true;
  const bool moving = linked_ || head_.source() == HeadInput::Source::pointer;
  if (!moving) return false;
  const AircraftState eye = eyeState(now);
  return !samePose(eye, *drawnEye_) || darkAt(eye.time) != drawnDark_;
}

/// Returns the symbols of the host that an image at `time` does not show, because they flash.
std::vector<std::uint16_t> Session::darkAt(double time) const {
  if (!hostSymbols_ || !parameters_->symbology.enabled || !parameters_->symbolHost.show) return {};
  return darkSymbols(*hostSymbols_, time);
}

/// Returns the aircraft's state for symbols; what the host does not send is derived from its positions, and
/// labelled so.
SymbologyState Session::symbols(const AircraftState& eye) const {
  SymbologyState symbols;
  symbols.aircraft = eye.attitude;
  symbols.view = lineOfSight(eye.attitude, eye.head);
  symbols.altitude = eye.position.height;
  symbols.velocity = velocityOf(eye);
  symbols.speed = eye.airspeed;
  symbols.groundSpeed = !eye.airspeed;
  if (!eye.airspeed && symbols.velocity)
    symbols.speed =
        MetresPerSecond{std::hypot(symbols.velocity->north.value(), symbols.velocity->east.value())}
            .as<Knots>();
  return symbols;
}

std::optional<Velocity> Session::velocityOf(const AircraftState& state) const {
  return state.velocity ? state.velocity : groundVelocity_.velocity();
}

std::optional<FrameRequest> Session::request(double now, int windowWidthPx, int windowHeightPx, ViewFit fit) {
  if (!current_) return std::nullopt;
  imageRate_.add(now);
  if (decidesImages()) decideImage(now);
  AircraftState eye = eyeState(now);
  FrameRequest request;
  request.time = eye.time;
  request.eye = eye.position;
  request.velocity = velocityOf(eye);
  request.wind = windOf(eye, parameters_->weather);
  air_.drift.advance(eye.time, eye.position, request.wind);
  request.airDrift = air_.drift.metres();
  request.attitude = lineOfSight(eye.attitude, eye.head);
  request.view = viewShape(parameters_->view, windowWidthPx, windowHeightPx, eye.view);
  if (fit == ViewFit::fill && parameters_->view.renderSize == RenderSize::fit)
    request.view = filledShape(request.view);
  request.decision = decision_;
  MotionBlur& blur = request.decision.motion.blur;
  if (blur.strength > 0) {
    if (!blurPicturedAt_) blurPicturedAt_ = now;
    blur.remainingMs -= std::max(now - *blurPicturedAt_, 0.0) * 1e3;
    if (!(blur.remainingMs > 0)) blur = {};
  }
  request.cullingCase = parameters_->culling.cullingCase;
  request.occlusion = parameters_->culling.occlusion;
  request.backFaces = parameters_->culling.backFaces;
  request.spreadFrom = parameters_->lod.spreadFrom;
  request.scaleTexture = parameters_->lod.texture;
  request.staticLod = parameters_->staticLod;
  request.terrain = parameters_->terrain;
  request.levers = leversOf(request.decision, *parameters_);
  request.rain = parameters_->rainLook;
  request.snow = parameters_->snowLook;
  request.precipitationForm = parameters_->weather.precipitationForm;
  air_.fade.advance(eye.time, decision_.weather);
  request.fading = air_.fade.fading();
  holdBudget(request);
  blurDrawn_ = request.levers.drawn.blurStrength > 0;
  if (rows_.size() > completeRows_) rows_.back().levers = request.levers;
  drawnDark_ = darkAt(eye.time);
  if (parameters_->symbology.enabled)
    request.symbology =
        SymbologyRequest{symbols(eye), symbologySetup(*parameters_), hostSymbols_, drawnDark_};
  latency_.requested(now);
  requestedDecideMs_ += std::exchange(decideMs_, 0);
  requestedRows_ = rows_.size();
  dirty_ = false;
  drawnEye_ = std::move(eye);
  return request;
}

/// Runs the chain's last step: lowers the levers of a request until its predicted time fits the budget, if
/// the preset asks for that. What was decided for a row of a trace is applied as it is.
void Session::holdBudget(FrameRequest& request) {
  const HoldParameters& p = parameters_->hold;
  const std::optional<HoldDecision> replayed = std::exchange(budget_.replayed, std::nullopt);
  budget_.ahead.push(request.time, {request.eye, request.attitude});
  if (!p.enabled) return;
  const auto images = static_cast<std::size_t>(p.lookAhead.value());
  const HoldGiven given =
      budget_.hold.look(request, budget_.ahead.coming(images), parameters_->measure.budget.value());
  const HoldDecision decision =
      replayed ? budget_.hold.replay(given, *replayed, request) : budget_.hold.decide(given, p, request);
  if (keepRows_ && rows_.size() > completeRows_) rows_.back().hold = decision;
}

std::span<const std::uint32_t> Session::nodesAhead(const FrameRequest& drawn) {
  const auto images = static_cast<std::size_t>(parameters_->hold.lookAhead.value());
  return budget_.hold.nodesAhead(drawn, budget_.ahead.coming(images));
}

double Session::aheadMs() const {
  const double budget = parameters_->measure.budget.value();
  return std::max((budget - workMs(lastCost_)) / 2, budget / 50);
}

FrameCost Session::costOf(const FrameResult& result) const {
  FrameCost cost = result.cost;
  cost.decide = requestedDecideMs_;
  cost.total += requestedDecideMs_;
  return cost;
}

FrameCost Session::finished(const FrameResult& result, double now) {
  lastCost_ = costOf(result);
  requestedDecideMs_ = 0;
  lastVertices_ = result.visible.vertices;
  if (parameters_->hold.enabled) budget_.hold.finished(result, lastCost_);
  signals_.tracker.finished(lastCost_.total, parameters_->measure.budget.value(), result.visible.triangles);
  overBudget_ += lastCost_.total > parameters_->measure.budget.value();
  latency_.finished(now);
  if (requestedRows_ > completeRows_) {
    const VisibleSet& visible = result.visible;
    rows_[requestedRows_ - 1].frame =
        TraceFrame{{visible.triangles, visible.vertices, visible.tiles.size(), visible.outsideFrustum,
                    visible.occluded, visible.beyondVisibility, visible.backFacing},
                   lastCost_};
    completeRows_ = requestedRows_;
  }
  return lastCost_;
}

void Session::noPicture() {
  if (decidesImages()) decideImage(lastArrival_);
  latency_.dropped();
  decideMs_ = requestedDecideMs_ = 0;
  completeRows_ = requestedRows_ = rows_.size();
}

}  // namespace trimtab
