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
///
/// The triangles of an image depend on the levers that a rule may set from them, and jump where many nodes
/// change their level at once. So that such a lever does not swing, the signal follows at once the way that
/// it goes, and turns round only if the count is three tenths away. While the view rests (it stays within a
/// metre and a twentieth of a degree of where the rest began) it turns twice at most, and then the lever
/// rests too.
class SignalTracker {
 public:
  /// Adds a state, with the height above ground, the velocity and the weather that its decision uses.
  void push(const AircraftState& state, std::optional<Metres> aboveGround,
            const std::optional<Velocity>& velocity, const WeatherDecision& weather);
  /// Adds a finished image: its work time over the budget, and its triangles. A work time that is not
  /// positive and finite, or a budget that is not, is left out.
  void finished(double workMs, double budgetMs, std::uint64_t triangles);
  /// Says that something other than the view has changed what an image has: the parameters, the terrain.
  void imageChanged() {
    view_.reset();
    turns_ = trianglesGo_ = 0;
  }
  /// Returns the signals after the last state and image.
  const SignalValues& values() const { return values_; }
  /// Forgets everything.
  void restart() { *this = {}; }

 private:
  /// What an image is seen from and through, where a rest began.
  struct View {
    GeodeticPosition eye;
    Attitude sight;
    double visibilityM = 0;
  };
  static bool restsAt(const View& view, const View& now);
  void filter(Signal signal, double value, double dt);
  void countTriangles(double triangles);

  SignalValues values_;
  std::optional<double> time_;  ///< of the last state
  Vec3 sight_, head_;           ///< unit vectors of the last state
  bool hasHead_ = false;
  std::array<double, 9> loads_{};
  std::size_t loadCount_ = 0;
  std::optional<View> view_;
  int trianglesGo_ = 0;  ///< -1 or 1, the way of their last change
  int turns_ = 0;        ///< of that way while the view rests
};

}  // namespace trimtab
