// SPDX-License-Identifier: GPL-3.0-or-later
#include "flight_playback.h"

#include <algorithm>
#include <cmath>

namespace trimtab::workbench {
namespace {

constexpr double kLongestStepS = 0.5;
/// A row within this part of a step from the grid is on it, however its time was rounded.
constexpr double kRounding = 1e-6;

}  // namespace

void FlightPlayback::load(Flight flight) {
  flight_ = std::move(flight);
  playing_ = false;
  seek(0);
}

double FlightPlayback::duration() const {
  return flight_.states.empty() ? 0 : flight_.states.back().time - flight_.states.front().time;
}

void FlightPlayback::play(double now) {
  if (!loaded()) return;
  if (position_ >= duration()) seek(0);
  lastNow_ = now;
  playing_ = true;
}

void FlightPlayback::seek(double position) {
  position_ = std::isfinite(position) ? std::clamp(position, 0.0, duration()) : 0;
  nextStep_ = static_cast<std::int64_t>(std::ceil(position_ * kRateHz));
}

AircraftState FlightPlayback::gridState(std::int64_t step) const {
  AircraftState state = stateAt(flight_, flight_.states.front().time + static_cast<double>(step) / kRateHz);
  state.packet = static_cast<std::uint64_t>(step) + 1;
  return state;
}

AircraftState FlightPlayback::current() const {
  return gridState(static_cast<std::int64_t>(std::floor(position_ * kRateHz + kRounding)));
}

void FlightPlayback::advance(double now, std::vector<AircraftState>& states) {
  if (!playing_) return;
  const double step = std::clamp(now - lastNow_, 0.0, kLongestStepS) * speed_;
  lastNow_ = now;
  double target = position_ + step;
  const double end = duration();
  const auto fly = [&](double until) {
    for (; static_cast<double>(nextStep_) / kRateHz <= until; ++nextStep_)
      states.push_back(gridState(nextStep_));
    position_ = until;
  };
  if (target < end) return fly(target);
  fly(end);
  if (!loop_) {
    playing_ = false;
    return;
  }
  target -= end;
  seek(0);
  fly(std::min(target, end));
}

}  // namespace trimtab::workbench
