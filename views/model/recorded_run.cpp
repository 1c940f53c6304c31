// SPDX-License-Identifier: GPL-3.0-or-later
#include "recorded_run.h"

#include "trimtab/hold/cost_model.h"

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

}  // namespace trimtab::views
