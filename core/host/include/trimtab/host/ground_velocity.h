#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "trimtab/frame/frame.h"

namespace trimtab {

/// Velocity over the ground from successive states, for hosts that send positions alone.
class GroundVelocity {
 public:
  /// States in the order of their times; starts over after a jump, a silence, or a time that is not later.
  void push(const AircraftState& state);
  /// As of the last state, over about a quarter of a second before it; none before the second state.
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
