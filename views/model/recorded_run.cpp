// SPDX-License-Identifier: GPL-3.0-or-later
#include "recorded_run.h"

#include <cmath>
#include <utility>

#include "trimtab/hold/cost_model.h"
#include "trimtab/measure/statistics.h"

namespace trimtab::views {

bool RecordedRun::add(const LiveFrame& frame) {
  const AircraftState& state = frame.input.state;
  if (!states_.empty()) {
    if (state.time - states_.front().time > kLongestS) return false;
    if (!(state.time > states_.back().time)) return true;
  }
  states_.push_back(state);
  ms_.push_back(workMs(frame.cost));
  return true;
}

std::vector<double> RecordedRun::mediansBySecond(double beginS) const {
  std::vector<std::vector<double>> seconds;
  for (std::size_t i = 0; i < ms_.size(); ++i) {
    const double second = std::floor(states_[i].time - beginS);
    if (second < 0 || second > kLongestS) continue;
    const auto at = static_cast<std::size_t>(second);
    if (at >= seconds.size()) seconds.resize(at + 1);
    seconds[at].push_back(ms_[i]);
  }
  std::vector<double> medians;
  for (std::vector<double>& ms : seconds) medians.push_back(quantileOf(std::move(ms), 0.5));
  return medians;
}

}  // namespace trimtab::views
