#pragma once

#include "trimtab/policy/levers.h"

namespace trimtab {

/// Moves levers towards their targets, no faster than their rates, and not for less than their dead bands.
///
/// A lever at rest stays until its target is farther away than the dead band; then it moves all the way to
/// the target and rests there. So with targets that rest, every lever moves in one direction only and comes
/// to rest within (range / rate) seconds: no rule base can make it cycle unless the signals themselves do.
class LeverDrive {
 public:
  /// Moves on to `time`, in seconds on the clock of the states, and returns the new values. A target that is
  /// NaN stands for `neutral`, which must be a number within the hard range. The first call, and one after
  /// restart(), takes the targets at once. No lever moves if the time stands, goes back or is not a number;
  /// a gap counts as a quarter of a second at most.
  const LeverValues& follow(double time, const LeverValues& targets, const LeverValues& neutral);
  const LeverValues& values() const { return values_; }
  void restart();

 private:
  LeverValues values_;
  std::array<bool, kLevers> moving_{};
  double time_ = 0;
  bool begun_ = false;
};

}  // namespace trimtab
