#include "trimtab/session/host_link.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "trimtab/host/motion.h"
#include "trimtab/units/not_finite.h"

namespace trimtab {
namespace {

/// A jump is shown for so many seconds.
constexpr double kJumpShownS = 1;

}  // namespace

std::string_view toText(LinkState state) {
  constexpr std::string_view kNames[] = {"never", "live", "silent", "jumped"};
  const auto at = static_cast<std::size_t>(state);
  return at < std::size(kNames) ? kNames[at] : std::string_view{};
}

void HostLink::follow(const AircraftState& state, double arrival, const AircraftState* before) {
  const bool first = !std::exchange(connected_, true);
  if (first) clock_.restart();
  clock_.follow(state.time, arrival);
  if (!first && before != nullptr) {
    const double gap = std::max(arrival - lastArrival_, 0.0);
    if (isJump(before->position, state.position, gap, gap > longestGapS(*before))) {
      ++jumps_;
      lastJump_ = arrival;
    }
  }
  lastArrival_ = arrival;
  promisedS_ = state.deadReckoning ? longestGapS(state) : 0;
  extrapolator_.push(state);
}

void HostLink::leave() {
  connected_ = false;
  symbols_.reset();
}

LinkState HostLink::state(double now, Milliseconds silenceAfter) const {
  if (lastArrival_ == 0) return LinkState::never;
  if (now - lastArrival_ > std::max(silenceAfter.in<Seconds>(), promisedS_)) return LinkState::silent;
  if (jumps_ > 0 && now - lastJump_ < kJumpShownS) return LinkState::jumped;
  return LinkState::live;
}

double HostLink::packetAge(double now) const {
  return lastArrival_ == 0 ? kNan : now - lastArrival_;
}

AircraftState HostLink::aircraftAt(double now, Milliseconds silenceAfter) const {
  return extrapolator_.at(hostTime(now), silenceAfter.in<Seconds>());
}

}  // namespace trimtab
