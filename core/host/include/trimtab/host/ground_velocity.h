#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "trimtab/frame/frame.h"

namespace trimtab {

/// Computes the velocity over the ground from successive states, for hosts that send positions only.
class GroundVelocity {
 public:
  /// Adds a state. It starts over after a jump, a silence, or a state that is not later than the last one.
  void push(const AircraftState& state);
  /// Returns the mean velocity over about the last quarter of a second up to the last state; nothing before
  /// the second state.
  std::optional<Velocity> velocity() const { return velocity_; }
  void restart() { count_ = 0, velocity_.reset(); }

 private:
  struct Place {
    double time = 0;
    Vec3 ecef;
  };
  std::array<Place, 32> places_;  ///< oldest first
  std::size_t count_ = 0;
  GeodeticPosition last_;
  std::optional<Velocity> velocity_;
};

}  // namespace trimtab
