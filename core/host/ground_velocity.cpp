#include "trimtab/host/ground_velocity.h"

#include <algorithm>

#include "trimtab/host/motion.h"

namespace trimtab {
namespace {

/// Arrival times jitter by milliseconds: over so long that is a percent.
constexpr double kBaselineS = 0.25, kShortestS = 0.005;

}  // namespace

void GroundVelocity::push(const AircraftState& state) {
  const Vec3 here = toEcef(state.position);
  if (count_ > 0) {
    const double step = state.time - places_[count_ - 1].time;
    if (step == 0 && state.position == last_) return;
    if (!(step > 0) || step > kSilenceS || isJump(last_, state.position, step, false)) restart();
  }
  last_ = state.position;
  // The newest place that is a baseline away, and all that came after it.
  std::size_t from = 0;
  while (from + 1 < count_ && state.time - places_[from + 1].time >= kBaselineS) ++from;
  if (count_ == places_.size() && from == 0) from = 1;
  std::move(places_.begin() + static_cast<std::ptrdiff_t>(from),
            places_.begin() + static_cast<std::ptrdiff_t>(count_), places_.begin());
  count_ -= from;
  places_[count_++] = {state.time, here};

  const double baseline = state.time - places_[0].time;
  if (!(baseline >= kShortestS)) return;
  const Vec3 moved = eastNorthUp(state.position.latitude, state.position.longitude) *
                     ((here - places_[0].ecef) * (1 / baseline));
  velocity_ = Velocity{MetresPerSecond{moved.y}, MetresPerSecond{moved.x}, MetresPerSecond{-moved.z}};
}

}  // namespace trimtab
