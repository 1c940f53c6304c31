#include <algorithm>

#include "trimtab/host/decoder.h"
#include "trimtab/host/motion.h"

namespace trimtab {
namespace {

// Velocity over at least this long: where states carry arrival times, two neighbours may be a fraction of a
// millisecond apart, and their difference would throw the eye far ahead.
constexpr double kBaselineS = 0.05, kShortestS = 0.005;

}  // namespace

void Extrapolator::start(const AircraftState& state) {
  states_[0] = state;
  count_ = 1;
}

void Extrapolator::push(const AircraftState& state) {
  if (count_ == 0) return start(state);
  const AircraftState& last = states_[count_ - 1];
  const double seconds = state.time - last.time;
  if (seconds == 0) {
    states_[count_ - 1] = state;
    return;
  }
  if (!(seconds > 0) || seconds > longestGapS(last) || isJump(last.position, state.position, seconds, false))
    return start(state);
  if (count_ == states_.size()) {
    std::move(states_.begin() + 1, states_.end(), states_.begin());
    --count_;
  }
  states_[count_++] = state;
}

AircraftState Extrapolator::at(double time, double limitS) const {
  if (count_ == 0) return {};
  const AircraftState& last = states_[count_ - 1];
  const double limit = last.deadReckoning ? std::max(limitS, longestGapS(last)) : limitS;
  const double ahead = std::min(time - last.time, limit);
  if (!(ahead > 0 && limitS > 0)) return last;
  if (last.deadReckoning) return deadReckoned(last, ahead);
  std::size_t from = count_ - 1;
  while (from > 0 && last.time - states_[from].time < kBaselineS) --from;
  const AircraftState& before = states_[from];
  const double baseline = last.time - before.time;
  if (baseline < kShortestS) return last;

  const double fraction = 1 + ahead / baseline;
  AircraftState pose = last;
  pose.time = last.time + ahead;
  pose.position = blended(before.position, last.position, fraction);
  pose.attitude = blended(before.attitude, last.attitude, fraction);
  if (before.head && last.head) pose.head = blendedHead(*before.head, *last.head, fraction);
  return pose;
}

}  // namespace trimtab
