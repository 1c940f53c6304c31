#include "trimtab/culling/occlusion_choice.h"

#include <algorithm>
#include <cmath>

namespace trimtab {
namespace {

/// Weight of a new measurement in a running mean. At 0.3 late frames displaced the best method more often.
constexpr double kFollow = 0.2;
/// A measurement counts as at most so many times the mean. Without this limit one late frame could displace
/// the best method for a second.
constexpr double kUsual = 4;
/// A method is assumed to hide at most this share of the triangles that the current one leaves to be drawn.
constexpr double kMostOfRest = 1.0 / 3;

double follow(double known, double measured) {
  constexpr double kLeastMs = 0.5;  // a limit of a few microseconds would be all noise
  return known + kFollow * (std::min(measured, std::max(kUsual * known, kLeastMs)) - known);
}

double angleBetween(Vec3 a, Vec3 b) {
  const double lengths = length(a) * length(b);
  return lengths > 0 ? std::acos(std::clamp(dot(a, b) / lengths, -1.0, 1.0)) : 0;
}

}  // namespace

std::size_t OcclusionChoice::armOf(Method method) {
  return method ? static_cast<std::size_t>(*method) : 0;
}

OcclusionChoice::Method OcclusionChoice::methodOf(std::size_t arm) {
  static_assert(static_cast<std::size_t>(OcclusionMethod::automatic) == 0);
  static_assert(static_cast<std::size_t>(OcclusionMethod::depth_map) + 1 == kArms);
  return arm == 0 ? Method{} : static_cast<OcclusionMethod>(arm);
}

double OcclusionChoice::msPerTriangle() const {
  if (!(inView_ > 0)) return 0;
  // The first guess, that all of the time to draw follows the triangles, weighs as much as one frame in which
  // a tenth of the triangles changed.
  const double weight = 0.01 * inView_ * inView_;
  return std::clamp((products_ + guessMs_ * weight) / (squares_ + weight), 0.0, mostMs_);
}

double OcclusionChoice::worth(std::size_t arm) const {
  const Arm& a = arms_[arm];
  return arm == 0 || !a.known ? 0 : msPerTriangle() * a.share * inView_ - a.costMs;
}

double OcclusionChoice::startMs(std::size_t arm) const {
  return std::max(0.0, arms_[arm].firstMs - arms_[arm].costMs);
}

bool OcclusionChoice::isHopeless(std::size_t arm) const {
  const Arm &a = arms_[arm], &current = arms_[current_];
  if (!a.known || !current.known || arm == current_) return false;
  const double all = msPerTriangle() * inView_;
  if (arm == 0) return kMostOfRest * all * current.share > current.costMs;
  if (current_ == 0) return a.costMs > all;
  return a.costMs - current.costMs > kMostOfRest * all * (1 - current.share);
}

bool OcclusionChoice::isDue(std::size_t arm, const Situation& now) const {
  const Arm& a = arms_[arm];
  const double patience = a.patience * (isHopeless(arm) ? kMostPatience : 1);
  return isNew(arm) || now.timeMs - a.last.timeMs > patience * kBelievedMs ||
         length(now.eye - a.last.eye) > patience * kBelievedM ||
         angleBetween(now.forward, a.last.forward) > patience * kBelievedTurn;
}

/// Milliseconds that a trial is likely to lose against the current method.
double OcclusionChoice::lossOfTrying(std::size_t arm) const {
  if (arm != 0 && !arms_[arm].known) return 0;
  return startMs(arm) + startMs(current_) + std::max(0.0, worth(current_) - worth(arm));
}

std::size_t OcclusionChoice::best() const {
  std::size_t best = !arms_[current_].canServe || worth(current_) < 0 ? 0 : current_;
  for (std::size_t arm = 0; arm < kArms; ++arm) {
    if (!arms_[arm].canServe || !arms_[arm].known || arm == best) continue;
    // It has to win back what starting it costs while it is believed.
    const double better = worth(arm) - worth(best);
    if (better > 0 && better * kBelievedMs > startMs(arm) * frameMs_) best = arm;
  }
  return best;
}

OcclusionChoice::Method OcclusionChoice::choose(const Situation& situation) {
  chapter_ += situation.band != now_.band || situation.timeMs - now_.timeMs > kBelievedMs ||
              !(length(situation.eye - now_.eye) <= kLeapM);
  now_ = situation;
  now_.methods = {};
  for (Arm& arm : arms_) arm.canServe = false;
  arms_[0].canServe = true;
  for (const OcclusionMethod method : situation.methods) arms_[armOf(method)].canServe = true;
  if (trialLeft_ > 0 && arms_[served_].canServe) {
    --trialLeft_;
    ++trials_;
    return methodOf(served_);
  }
  trialLeft_ = 0;
  if (!(frameMs_ > 0)) return methodOf(current_ = served_ = 0);
  served_ = current_ = best();
  // The one that was used the longest time ago is tried first.
  const auto since = [&](std::size_t arm) { return arms_[arm].known ? arms_[arm].last.timeMs : -1e300; };
  for (std::size_t arm = 0; arm < kArms; ++arm)
    if (arms_[arm].canServe && arm != current_ && isDue(arm, situation) &&
        price(lossOfTrying(arm)) <= arms_[arm].budgetMs &&
        (served_ == current_ || since(arm) < since(served_)))
      served_ = arm;
  if (served_ != current_) {
    // The first frame builds what later frames keep, so it takes a second one to know the cost.
    trialLeft_ = served_ != 0 && isNew(served_);
    ++trials_;
  }
  return methodOf(served_);
}

void OcclusionChoice::learnTriangleCost(const Outcome& outcome) {
  const auto drawn = static_cast<double>(outcome.drawn), all = drawn + static_cast<double>(outcome.hidden);
  if (drawn > 0) {
    mostMs_ = outcome.drawMs / drawn;
    guessMs_ = outcome.drawMs / all;
  }
  if (previous_) {
    const double more = drawn - static_cast<double>(previous_->drawn);
    // A frame with many more or fewer triangles replaces what is known; a frame with as many keeps it.
    const double keep = std::exp(-more * more / std::max(all * all, 1.0));
    squares_ = keep * squares_ + more * more;
    products_ = keep * products_ + more * (outcome.drawMs - previous_->drawMs);
  }
  previous_ = outcome;
}

void OcclusionChoice::learnArm(const Outcome& outcome) {
  Arm& arm = arms_[served_];
  const bool first = before_ != served_, isNew = this->isNew(served_);
  arm.chapter = chapter_;
  // The current method keeps what is known of it; a method that is tried anew may cost something else.
  if (isNew && served_ != current_) arm.frames = 0;
  if (arm.frames == 0)
    // The very first frame also builds what is kept for good, so it counts as one frame's time at most.
    arm.firstMs = arm.costMs = std::min(outcome.occlusionMs, frameMs_);
  else if (arm.frames == 1)
    arm.costMs = std::min(arm.firstMs, outcome.occlusionMs);
  else if (first && arm.firstMs > 0)
    arm.firstMs = follow(arm.firstMs, outcome.occlusionMs);
  else
    arm.costMs = follow(arm.costMs, outcome.occlusionMs);
  arm.frames = std::min(arm.frames + 1, 2);
  if (served_ == current_ || isNew || (arm.last.rule != now_.rule && !isHopeless(served_)))
    arm.patience = 1;
  else if (first)
    arm.patience = std::min(2 * arm.patience, kMostPatience);
  arm.known = true;
  arm.last = now_;
  const auto all = static_cast<double>(outcome.drawn + outcome.hidden);
  arm.share = served_ != 0 && all > 0 ? static_cast<double>(outcome.hidden) / all : 0;
}

void OcclusionChoice::learn(const Outcome& outcome) {
  if (!std::isfinite(outcome.occlusionMs) || !std::isfinite(outcome.drawMs) ||
      !std::isfinite(outcome.totalMs))
    return;
  learnTriangleCost(outcome);
  frameMs_ = frameMs_ > 0 ? follow(frameMs_, outcome.totalMs) : outcome.totalMs;
  inView_ = static_cast<double>(outcome.drawn + outcome.hidden);
  learnArm(outcome);
  // A trial pays with its own budget for what it lost, and for the restart of the method it interrupted.
  const double worthNow = msPerTriangle() * static_cast<double>(outcome.hidden) - outcome.occlusionMs;
  if (served_ != current_)
    arms_[served_].budgetMs -= price(std::max(0.0, worth(current_) - worthNow));
  else if (before_ != served_ && before_ < kArms)
    arms_[before_].budgetMs -= price(std::max(0.0, outcome.occlusionMs - arms_[served_].costMs));
  // Each method has a budget of its own, so that one that is expensive to try is tried too.
  const auto waits = [&](std::size_t arm) { return arms_[arm].canServe && arm != current_; };
  double others = 0;
  for (std::size_t arm = 0; arm < kArms; ++arm) others += waits(arm);
  for (std::size_t arm = 0; arm < kArms; ++arm)
    if (waits(arm))
      arms_[arm].budgetMs = std::min(arms_[arm].budgetMs + kExploring * frameMs_ / others,
                                     std::max(2 * frameMs_, price(lossOfTrying(arm))));
  before_ = served_;
}

}  // namespace trimtab
