#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "trimtab/frame/frame.h"

namespace trimtab {

/// Computes an aircraft's velocity relative to the earth from the positions of successive states, for hosts
/// that send no velocity.
class GroundVelocity {
 public:
  /// Adds a state; `state.time` is the host's clock, in seconds. A state to which no aircraft can have flown
  /// (isJump), one that comes more than kSilenceS after the last, and one that is not later than it, forget
  /// all earlier states and become the first.
  void push(const AircraftState& state);
  /// Returns the mean velocity (north, east and down) between the last state and the one a quarter of a
  /// second before it: the state just before that if states are farther apart, and the oldest of 32 if they
  /// are denser. Returns nullopt until two states without a restart between them are known.
  std::optional<Velocity> velocity() const { return velocity_; }
  /// Forgets all states.
  void restart() { count_ = 0, velocity_.reset(); }

 private:
  struct Place {
    double time = 0;  ///< seconds on the host's clock
    Vec3 ecef;
  };
  std::array<Place, 32> places_;  ///< oldest first
  std::size_t count_ = 0;
  GeodeticPosition last_;
  std::optional<Velocity> velocity_;
};

}  // namespace trimtab
