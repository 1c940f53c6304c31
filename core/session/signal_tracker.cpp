#include "trimtab/session/signal_tracker.h"

#include <algorithm>
#include <cmath>

#include "trimtab/motion/line_of_sight.h"

namespace trimtab {
namespace {

constexpr double kLongestGapS = 1, kUnknown = std::numeric_limits<double>::quiet_NaN();

double finiteOr(double value, double otherwise) {
  return std::isfinite(value) ? value : otherwise;
}

}  // namespace

void SignalTracker::filter(Signal signal, double value, double dt) {
  double& kept = values_[signal];
  const double tau = rowOf(signal).filterS;
  // The step follows the time between states, so that the filter is the same for any host's rate.
  if (std::isnan(value) || std::isnan(kept) || !(tau > 0))
    kept = value;
  else
    kept += (value - kept) * -std::expm1(-dt / tau);
}

void SignalTracker::push(const AircraftState& state, std::optional<Metres> aboveGround,
                         const std::optional<Velocity>& velocity, const WeatherDecision& weather) {
  const double dt = time_ ? state.time - *time_ : kUnknown;
  const bool follows = dt > 0 && dt <= kLongestGapS;
  viewMoved_ = false;
  if (dt == 0) return;  // the same moment again

  values_[Signal::altitude] = finiteOr(state.position.height.in<Feet>(), kUnknown);
  values_[Signal::above_ground] = aboveGround ? finiteOr(aboveGround->in<Feet>(), kUnknown) : kUnknown;
  values_[Signal::pitch] = finiteOr(state.attitude.pitch.value(), kUnknown);
  const double roll = std::remainder(state.attitude.roll.value(), 360.0);
  values_[Signal::roll] = finiteOr(std::abs(roll), kUnknown);
  double speed = kUnknown, climb = kUnknown;
  if (velocity) {
    const double north = velocity->north.value(), east = velocity->east.value(),
                 down = velocity->down.value();
    speed = MetresPerSecond{std::sqrt(north * north + east * east + down * down)}.as<Knots>().value();
    climb = -Metres{down}.in<Feet>() * 60;
  }
  if (state.airspeed) speed = state.airspeed->value();
  const double filterStep = follows ? dt : std::numeric_limits<double>::infinity();
  filter(Signal::speed, finiteOr(speed, kUnknown), filterStep);
  filter(Signal::climb, finiteOr(climb, kUnknown), filterStep);
  values_[Signal::visibility] = std::min(weather.visibilityM, rowOf(Signal::visibility).range.high);
  values_[Signal::precipitation] = weather.density;

  const Attitude look = lineOfSight(state.attitude, state.head);
  if (const View now{state.position, look, weather.visibilityM}; !view_ || !restsAt(*view_, now)) {
    view_ = now;
    viewMoved_ = true;
    images_.viewMoved();
  }
  const Vec3 sight = directionOf(look);
  const Vec3 head = state.head ? directionOf(*state.head) : Vec3{};
  const bool bothHeads = hasHead_ && state.head;
  if (!follows) values_[Signal::sight_rate] = values_[Signal::head_rate] = kUnknown;
  if (!state.head) values_[Signal::head_rate] = kUnknown;
  if (follows) {
    filter(Signal::sight_rate, finiteOr(degreesBetween(sight_, sight) / dt, kUnknown), dt);
    if (bothHeads) filter(Signal::head_rate, finiteOr(degreesBetween(head_, head) / dt, kUnknown), dt);
  }
  sight_ = sight;
  head_ = head;
  hasHead_ = state.head.has_value();
  if (std::isfinite(state.time))
    time_ = state.time;
  else
    time_.reset();
}

bool SignalTracker::restsAt(const View& view, const View& now) {
  constexpr double kMetres = 1, kDegrees = 0.05, kMetresPerDegree = 111320;
  const auto within = [](Degrees a, Degrees b, double degrees) {
    return std::abs(std::remainder(a.value() - b.value(), 360.0)) <= degrees;
  };
  return within(view.eye.latitude, now.eye.latitude, kMetres / kMetresPerDegree) &&
         within(view.eye.longitude, now.eye.longitude, kMetres / kMetresPerDegree) &&
         std::abs((view.eye.height - now.eye.height).value()) <= kMetres &&
         within(view.sight.heading, now.sight.heading, kDegrees) &&
         within(view.sight.pitch, now.sight.pitch, kDegrees) &&
         within(view.sight.roll, now.sight.roll, kDegrees) && view.visibilityM == now.visibilityM;
}

/// Reports whether the signal follows; notes the direction and the turn if it does.
bool ImageSignals::mayChange(double from, double to, double band, bool risesAlways, Loop& loop) {
  constexpr int kMostTurns = 2;
  const int way = (to > from) - (to < from);
  if (way != 0 && way == -loop.goes) {
    if (std::abs(to - from) <= band * from) return false;
    const bool spent = loop.turns >= kMostTurns;
    if (spent && !(risesAlways && way > 0)) return false;
    ++loop.turns;
  }
  if (way != 0) loop.goes = way;
  return true;
}

void ImageSignals::finished(double workMs, double budgetMs, std::uint64_t triangles) {
  constexpr double kTrianglesBand = 0.3, kLoadBand = 0.15;
  const double counted = static_cast<double>(triangles);
  if (mayChange(triangles_, counted, kTrianglesBand, false, trianglesLoop_)) triangles_ = counted;
  if (!(workMs > 0 && budgetMs > 0 && std::isfinite(workMs) && std::isfinite(budgetMs))) return;
  loads_[loadCount_++ % kLoadImages] = workMs / budgetMs;
  std::array<double, kLoadImages> sorted = loads_;
  const std::size_t count = std::min(loadCount_, sorted.size());
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(count / 2);
  std::nth_element(sorted.begin(), middle, sorted.begin() + static_cast<std::ptrdiff_t>(count));
  if (mayChange(load_, *middle, kLoadBand, true, loadLoop_)) load_ = *middle;
}

}  // namespace trimtab
