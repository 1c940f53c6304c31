#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "trimtab/frame/frame.h"
#include "trimtab/policy/signals.h"
#include "trimtab/units/not_finite.h"

namespace trimtab {

/// Derives load and triangles, the signals that depend on the levers that a rule may set from them: work time
/// has noise, and triangles jump where many nodes change their level at once. So that such a lever does not
/// swing, these two follow at once the way that they go, and turn round only for a change beyond a band:
/// three tenths of the triangles, 15 % of the load. While the view rests each turns twice at most. After that
/// the triangles stay as they are and the load may only rise, because another program may take the machine;
/// so a lever that follows them comes to rest for any rules.
class ImageSignals {
 public:
  /// The load is the median of so many images.
  static constexpr std::size_t kLoadImages = 9;

  /// Adds a finished image: its work time over the budget, and its triangles. A work time that is not
  /// positive and finite, or a budget that is not, is left out.
  void finished(double workMs, double budgetMs, std::uint64_t triangles);
  /// Says that the view has moved, so that each signal may turn again.
  void viewMoved() { loadLoop_.turns = trianglesLoop_.turns = 0; }
  /// Says that something other than the view has changed what an image has: the parameters, the terrain.
  void imageChanged() { loadLoop_ = trianglesLoop_ = {}; }
  /// Writes the two signals; both are unknown before the first image.
  void writeTo(SignalValues& values) const {
    values[Signal::load] = load_;
    values[Signal::triangles] = triangles_;
  }

 private:
  /// Keeps a signal from swinging with a lever that follows it.
  struct Loop {
    int goes = 0;   ///< -1 or 1, the way of the last change
    int turns = 0;  ///< of that way while the view rests
  };
  static bool mayChange(double from, double to, double band, bool risesAlways, Loop& loop);

  double load_ = kNan, triangles_ = kNan;
  std::array<double, kLoadImages> loads_{};
  std::size_t loadCount_ = 0;
  Loop loadLoop_, trianglesLoop_;
};

/// Derives the signals of a policy from successive states and finished images. Rates follow from the states'
/// own time stamps: steps may be irregular, angles may wrap, and time that goes back or stands for a second
/// begins anew. The view rests while it stays within a metre and a twentieth of a degree of where the rest
/// began.
class SignalTracker {
 public:
  /// Adds a state, with the height above ground, the velocity and the weather that its decision uses.
  void push(const AircraftState& state, std::optional<Metres> aboveGround,
            const std::optional<Velocity>& velocity, const WeatherDecision& weather);
  /// Adds a finished image, as ImageSignals does.
  void finished(double workMs, double budgetMs, std::uint64_t triangles) {
    images_.finished(workMs, budgetMs, triangles);
    images_.writeTo(values_);
  }
  /// Says that something other than the view has changed what an image has: the parameters, the terrain.
  void imageChanged() {
    view_.reset();
    images_.imageChanged();
  }
  /// Returns the signals after the last state and image.
  const SignalValues& values() const { return values_; }
  /// Reports whether the last state moved the view, or was the first.
  bool viewMoved() const { return viewMoved_; }
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

  SignalValues values_;
  std::optional<double> time_;  ///< of the last state
  Vec3 sight_, head_;           ///< unit vectors of the last state
  bool hasHead_ = false, viewMoved_ = false;
  std::optional<View> view_;
  ImageSignals images_;
};

}  // namespace trimtab
