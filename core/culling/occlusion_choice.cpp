#include "trimtab/culling/occlusion_choice.h"

#include <algorithm>
#include <cmath>

namespace trimtab {
namespace {

/// Frames of a method's first trial in a chapter: the first builds what later ones keep. How these two
/// compare is known afterwards, and one frame tells how much there is to hide.
constexpr int kFirstTrialFrames = 4;
/// A method that starts must win back within so many frames what starting costs.
constexpr double kWonBackFrames = 30;
/// Another method must be so much better, as a share of the frame.
constexpr double kBetter = 0.01;
/// How fast what is known follows what is measured, and how much of it a change of all triangles drives out.
constexpr double kFollow = 0.3, kForget = 0.5;
/// One frame may be late for reasons of its own: it counts as at most so many times what is usual.
constexpr double kUsual = 4;
/// Before anything is known, of the time to draw so much is taken to follow the triangles.
constexpr double kFollowsTriangles = 0.5;
/// What a method is taken to cost before it was tried, as a share of the frame.
constexpr double kUnknownShare = 0.2;
/// Of what the method in use leaves to be drawn, another one is taken to hide so much at most (of what none
/// leaves, all); and where it saves so many times its cost, none is no better.
constexpr double kMostOfRest = 1.0 / 3, kSurelySaves = 4;
/// What its very first frame is believed to have cost, at most.
constexpr double kMostFirstShare = 0.5;

double follow(double known, double measured) {
  return known + kFollow * (std::min(measured, std::max(kUsual * known, 0.5)) - known);
}

double turned(Vec3 a, Vec3 b) {
  const double lengths = length(a) * length(b);
  return lengths > 0 ? std::acos(std::clamp(dot(a, b) / lengths, -1.0, 1.0)) : 0;
}

}  // namespace

std::size_t OcclusionChoice::armOf(Method method) {
  return method ? static_cast<std::size_t>(*method) : 0;
}

OcclusionChoice::Method OcclusionChoice::methodOf(std::size_t arm) {
  static_assert(static_cast<std::size_t>(OcclusionMethod::automatic) == 0);
  static_assert(static_cast<std::size_t>(OcclusionMethod::horizon_and_map) + 1 == kArms);
  return arm == 0 ? Method{} : static_cast<OcclusionMethod>(arm);
}

double OcclusionChoice::msPerTriangle() const {
  if (!(inView_ > 0)) return 0;
  // The guess counts as much as a change of a tenth of the triangles.
  const double weight = 0.01 * inView_ * inView_;
  return std::clamp((products_ + guessMs_ * weight) / (squares_ + weight), 0.0, mostMs_);
}

double OcclusionChoice::worth(std::size_t arm) const {
  const Arm& a = arms_[arm];
  return arm == 0 || !a.known ? 0 : msPerTriangle() * a.share * inView_ - a.costMs;
}

double OcclusionChoice::worthMs(Method method) const {
  return worth(armOf(method));
}

double OcclusionChoice::startMs(std::size_t arm) const {
  return std::max(0.0, arms_[arm].firstMs - arms_[arm].costMs);
}

/// Whether it would be no better than the one in use though it hid a good part of what that leaves: what it
/// costs is known from its last trial, what is left to gain from every frame.
bool OcclusionChoice::isHopeless(std::size_t arm) const {
  const Arm &a = arms_[arm], &current = arms_[current_];
  if (!a.known || !current.known || arm == current_) return false;
  const double all = msPerTriangle() * inView_;
  if (arm == 0) return all * current.share > kSurelySaves * current.costMs;
  if (current_ == 0) return a.costMs > all;
  return a.costMs - current.costMs > kMostOfRest * all * (1 - current.share);
}

bool OcclusionChoice::isDue(std::size_t arm, const Situation& now) const {
  const Arm& a = arms_[arm];
  const bool hopeless = isHopeless(arm);
  const double patience = a.patience * (hopeless ? kHopelessPatience : 1);
  return isNew(arm) || (a.last.rule != now.rule && !hopeless) ||
         now.timeMs - a.last.timeMs > patience * kBelievedMs ||
         length(now.eye - a.last.eye) > patience * kBelievedM ||
         turned(now.forward, a.last.forward) > patience * kBelievedTurn;
}

/// What a trial is likely to lose against the method in use.
double OcclusionChoice::lossOfTrying(std::size_t arm) const {
  if (arm != 0 && !arms_[arm].known) return kUnknownShare * frameMs_;
  return startMs(arm) + startMs(current_) + std::max(0.0, worth(current_) - worth(arm));
}

std::size_t OcclusionChoice::best(std::span<const std::size_t> arms) const {
  std::size_t best = current_;
  if (std::find(arms.begin(), arms.end(), current_) == arms.end() || worth(current_) < 0) best = 0;
  for (const std::size_t arm : arms) {
    if (!arms_[arm].known || arm == best) continue;
    const double better = worth(arm) - worth(best);
    if (better > kBetter * frameMs_ && better * kWonBackFrames > startMs(arm)) best = arm;
  }
  return best;
}

OcclusionChoice::Method OcclusionChoice::choose(const Situation& situation) {
  // A single frame without a choice, or every second one, is no such while.
  chapter_ += situation.band != now_.band ||
              situation.timeMs - now_.timeMs > std::max(kBelievedMs, 4 * frameMs_) ||
              !(length(situation.eye - now_.eye) <= kLeapM);
  now_ = situation;
  now_.methods = {};
  std::array<std::size_t, kArms> list{};
  std::size_t count = 1;
  for (const OcclusionMethod method : situation.methods)
    if (method != OcclusionMethod::automatic && count < kArms)
      list[count++] = static_cast<std::size_t>(method);
  const std::span<const std::size_t> arms(list.data(), count);
  for (Arm& arm : arms_) arm.canServe = false;
  for (const std::size_t arm : arms) arms_[arm].canServe = true;
  const bool canGoOn = std::find(arms.begin(), arms.end(), served_) != arms.end();
  if (trialLeft_ > 0 && canGoOn) {
    --trialLeft_;
    ++trials_;
    return methodOf(served_);
  }
  trialLeft_ = 0;
  if (!(frameMs_ > 0)) return methodOf(current_ = served_ = 0);
  current_ = best(arms);
  served_ = current_;
  std::optional<std::size_t> longest;
  for (const std::size_t arm : arms) {
    if (arm == current_ || !isDue(arm, situation) || lossOfTrying(arm) > arms_[arm].purseMs) continue;
    const auto since = [&](std::size_t a) { return arms_[a].known ? arms_[a].last.timeMs : -1e300; };
    if (!longest || since(arm) < since(*longest)) longest = arm;
  }
  if (longest) {
    served_ = *longest;
    trialLeft_ = served_ == 0 || !isNew(served_) ? 0 : kFirstTrialFrames - 1;
    ++trials_;
  }
  return methodOf(served_);
}

void OcclusionChoice::learnTriangleCost(const Outcome& outcome) {
  const auto drawn = static_cast<double>(outcome.drawn), all = drawn + static_cast<double>(outcome.hidden);
  if (drawn > 0) {
    mostMs_ = outcome.drawMs / drawn;
    guessMs_ = kFollowsTriangles * outcome.drawMs / all;
  }
  if (previous_) {
    const double more = drawn - static_cast<double>(previous_->drawn);
    // What is new drives out what is old; what says nothing new does not.
    const double keep = std::exp(-kForget * more * more / std::max(all * all, 1.0));
    squares_ = keep * squares_ + more * more;
    products_ = keep * products_ + more * (outcome.drawMs - previous_->drawMs);
  }
  previous_ = outcome;
}

void OcclusionChoice::learnArm(const Outcome& outcome) {
  Arm& arm = arms_[served_];
  const bool first = before_ != served_, isNew = this->isNew(served_);
  arm.chapter = chapter_;
  // What serves goes on; what is tried may cost something else altogether.
  if (isNew && served_ != current_) arm.frames = 0;
  if (arm.frames < kFirstTrialFrames) {
    // The first frame also makes what is kept for good; it says the least about those that follow.
    if (arm.frames == 0)
      arm.firstMs = arm.costMs = std::min(outcome.occlusionMs, kMostFirstShare * frameMs_);
    else
      // No more than starting took: a second frame that is late for reasons of its own ends no trial.
      arm.costMs = std::min(arm.frames == 1 ? arm.firstMs : arm.costMs, outcome.occlusionMs);
    ++arm.frames;
  } else if (first && arm.firstMs > 0) {
    const double before = arm.firstMs;
    arm.firstMs = follow(before, outcome.occlusionMs);
    arm.costMs *= arm.firstMs / before;
  } else {
    arm.costMs = follow(arm.costMs, outcome.occlusionMs);
  }
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
  const auto all = static_cast<double>(outcome.drawn + outcome.hidden);
  const bool atStart = !(frameMs_ > 0);
  frameMs_ = frameMs_ > 0 ? follow(frameMs_, outcome.totalMs) : outcome.totalMs;
  inView_ = all;
  const bool trial = served_ != current_, first = before_ != served_;
  const bool isFirstEver = !arms_[served_].known;
  learnArm(outcome);
  const double worthNow = msPerTriangle() * static_cast<double>(outcome.hidden) - outcome.occlusionMs;
  if (trial) {
    const double loss = std::max(0.0, worth(current_) - worthNow);
    arms_[served_].purseMs -= isFirstEver ? std::min(loss, 2 * frameMs_) : loss;
    // Even for nothing it would not be better, or not at what its second frame has cost: no more of it.
    const double cost = arms_[served_].frames > 1 ? arms_[served_].costMs : 0;
    if (served_ != 0 &&
        msPerTriangle() * static_cast<double>(outcome.hidden) - cost <= worth(current_) + 1e-3)
      trialLeft_ = 0;
  } else if (first && before_ < kArms)  // after a trial of another one, or for good
    arms_[before_].purseMs -= std::max(0.0, outcome.occlusionMs - arms_[served_].costMs);
  // Each has its own purse, so that one that is dear to try comes to its turn as well. The first frame fills
  // them, so that all are tried soon.
  double others = 0;
  for (std::size_t arm = 0; arm < kArms; ++arm) others += arms_[arm].canServe && arm != current_;
  for (std::size_t arm = 0; arm < kArms; ++arm)
    if (arms_[arm].canServe && arm != current_)
      arms_[arm].purseMs = std::min(arms_[arm].purseMs + (atStart ? 1 : kExploring) * frameMs_ / others,
                                    std::max(2 * frameMs_, lossOfTrying(arm)));
  before_ = served_;
}

}  // namespace trimtab
