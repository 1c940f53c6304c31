#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "trimtab/frame/frame.h"
#include "trimtab/policy/signals.h"

namespace trimtab {

/// Derives the signals of a policy from successive states and finished images. Rates follow from the states'
/// own time stamps: steps may be irregular, angles may wrap, and time that goes back or stands for a second
/// begins anew.
class SignalTracker {
 public:
  /// Adds a state, with the height above ground, the velocity and the weather that its decision uses.
  void push(const AircraftState& state, std::optional<Metres> aboveGround,
            const std::optional<Velocity>& velocity, const WeatherDecision& weather);
  /// Adds a finished image: its work time over the budget, and its triangles. A work time that is not
  /// positive and finite, or a budget that is not, is left out.
  void finished(double workMs, double budgetMs, std::uint64_t triangles);
  /// Returns the signals after the last state and image.
  const SignalValues& values() const { return values_; }
  /// Forgets everything.
  void restart() { *this = {}; }

 private:
  void filter(Signal signal, double value, double dt);

  SignalValues values_;
  std::optional<double> time_;  ///< of the last state
  Vec3 sight_, head_;           ///< unit vectors of the last state
  bool hasHead_ = false;
  std::array<double, 9> loads_{};
  std::size_t loadCount_ = 0;
};

}  // namespace trimtab
