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
  /// Everything that a step depends on, for traces.
  struct State {
    LeverValues values = LeverValues::all(0);
    std::uint32_t moving = 0;  ///< bit l: lever l is on its way to a target
    double timeS = 0;          ///< of the last step
    bool begun = false;        ///< whether a step has set the values

    friend bool operator==(const State&, const State&) = default;
  };

  LeverDrive() = default;
  explicit LeverDrive(const State& state) : state_(state) {}

  /// Moves on to `time`, in seconds on the clock of the states, and returns the new values. A target that is
  /// NaN stands for `neutral`, which must be a number within the hard range. The first call, and one after
  /// restart(), takes the targets at once. No lever moves if the time stands, goes back or is not a number;
  /// a gap counts as a quarter of a second at most.
  const LeverValues& follow(double time, const LeverValues& targets, const LeverValues& neutral);
  const LeverValues& values() const { return state_.values; }
  const State& state() const { return state_; }
  /// Makes the next step take its targets at once.
  void restart() { state_ = {}; }

  friend bool operator==(const LeverDrive&, const LeverDrive&) = default;

 private:
  State state_;
};

}  // namespace trimtab
