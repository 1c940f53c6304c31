// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "views/model/live.h"

namespace trimtab::views {

/// What was flown and what its images took, so that it can be flown again under other parameters.
class RecordedRun {
 public:
  static constexpr double kLongestS = 120;

  /// Adds an image. Returns false, and adds nothing, once the run is `kLongestS` long. An image of a state
  /// that is not later than the one before it adds nothing.
  bool add(const LiveFrame& frame);

  std::size_t images() const { return states_.size(); }
  double durationS() const { return states_.empty() ? 0 : states_.back().time - states_.front().time; }
  /// Returns the states, at rising times, with the line of sight and the weather that they had.
  const std::vector<AircraftState>& states() const { return states_; }
  /// Returns the work time of the image of each state, milliseconds.
  const std::vector<double>& ms() const { return ms_; }
  /// Returns the median of each second's images, counted from the state time `beginS` on; NaN for a second
  /// without images. Images of one second are alike, so that seconds are what two runs are compared by.
  std::vector<double> mediansBySecond(double beginS) const;

 private:
  std::vector<AircraftState> states_;
  std::vector<double> ms_;
};

}  // namespace trimtab::views
