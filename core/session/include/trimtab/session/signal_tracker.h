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
/// Load and triangles of an image depend on the levers that a rule may set from them: work time has noise,
/// and triangles jump where many nodes change their level at once. So that such a lever does not swing, these
/// two signals follow at once the way that they go, and turn round only for a change beyond a band: three
/// tenths of the triangles, 15 % of the load. While the view rests (it stays within a metre and a twentieth
/// of a degree of where the rest began) each turns twice at most. After that the triangles stay as they are
/// and the load may only rise, because another program may take the machine; so a lever that follows them
/// comes to rest for any rules.
class SignalTracker {
 public:
  /// The load is the median of so many images.
  static constexpr std::size_t kLoadImages = 9;

  /// Adds a state, with the height above ground, the velocity and the weather that its decision uses.
  void push(const AircraftState& state, std::optional<Metres> aboveGround,
            const std::optional<Velocity>& velocity, const WeatherDecision& weather);
  /// Adds a finished image: its work time over the budget, and its triangles. A work time that is not
  /// positive and finite, or a budget that is not, is left out.
  void finished(double workMs, double budgetMs, std::uint64_t triangles);
  /// Says that something other than the view has changed what an image has: the parameters, the terrain.
  void imageChanged() {
    view_.reset();
    loadLoop_ = trianglesLoop_ = {};
  }
  /// Returns the signals after the last state and image.
  const SignalValues& values() const { return values_; }
  /// Forgets everything.
  void restart() { *this = {}; }

 private:
  /// Holds what an image is seen from and through, where a rest began.
  struct View {
    GeodeticPosition eye;
    Attitude sight;
    double visibilityM = 0;
  };
  static bool restsAt(const View& view, const View& now);
  void filter(Signal signal, double value, double dt);
  /// Keeps a signal from swinging with a lever that follows it.
  struct Loop {
    int goes = 0;   ///< -1 or 1, the way of the last change
    int turns = 0;  ///< of that way while the view rests
  };
  static bool mayChange(double from, double to, double band, bool risesAlways, Loop& loop);

  SignalValues values_;
  std::optional<double> time_;  ///< of the last state
  Vec3 sight_, head_;           ///< unit vectors of the last state
  bool hasHead_ = false;
  std::array<double, kLoadImages> loads_{};
  std::size_t loadCount_ = 0;
  std::optional<View> view_;
  Loop loadLoop_, trianglesLoop_;
};

}  // namespace trimtab
