#pragma once

#include "trimtab/policy/levers.h"

namespace trimtab {

/// Moves levers towards their targets, no faster than their rates, and not for less than their dead bands.
/// Rates, dead bands and hard ranges are in the rows of levers.h.
///
/// A lever at rest stays until its target is farther away than the dead band; then it moves all the way to
/// the target and rests there. So while targets stay as they are, every lever moves in one direction only and
/// comes to rest within (range / rate) seconds of the steps that count: no rule base can make it cycle unless
/// the signals themselves do.
class LeverDrive {
 public:
  /// Holds everything that a step depends on, for traces.
  struct State {
    LeverValues values = LeverValues::all(0);
    std::uint32_t moving = 0;  ///< bit l: lever l is on its way to a target
    double timeS = 0;          ///< of the last step whose time was a finite number
    bool begun = false;        ///< whether such a step has set the values; if not, the others do not count

    friend bool operator==(const State&, const State&) = default;
  };

  LeverDrive() = default;
  /// Goes on from a state that a trace has kept. The state is not checked.
  explicit LeverDrive(const State& state) : state_(state) {}

  /// Moves on to `time`, in seconds on the clock of AircraftState::time, and returns values(). A target that
  /// is NaN stands for `neutral`, which must be a number then. Targets are clamped to the hard range.
  ///
  /// The first call, and one after restart(), takes the targets at once, whatever the time is; if that is not
  /// a finite number, the next call does so again. Later no lever moves in a call whose time stands, goes
  /// back or is not a finite number. After a time that went back, the next call counts from there. A step
  /// counts as a quarter of a second at most.
  const LeverValues& follow(double time, const LeverValues& targets, const LeverValues& neutral);
  /// Returns the values of the last step; all are 0 before the first one, and after restart().
  const LeverValues& values() const { return state_.values; }
  const State& state() const { return state_; }
  /// Forgets everything, so that the next step takes its targets at once.
  void restart() { state_ = {}; }

  friend bool operator==(const LeverDrive&, const LeverDrive&) = default;

 private:
  State state_;
};

}  // namespace trimtab
