#pragma once

#include <optional>

#include "trimtab/frame/weather_decision.h"

namespace trimtab {

/// Lets rain and snow begin, change and end over some seconds of the host's clock, where a decision changes
/// at once. Rain that becomes snow ends first.
class PrecipitationFade {
 public:
  /// The time from dry air to the densest rain or snow; lower densities take their share of it.
  static constexpr double kFullS = 6;

  /// Moves the amount toward the decision's density over the time, in seconds, since the latest time so far.
  /// Time that goes back by up to 10 s is waited for, as AirDrift does; a longer step either way, a time that
  /// is no number, and the first call take the decision at once.
  void advance(double time, const WeatherDecision& weather);
  /// Makes the next call take its decision at once: an edit is shown as soon as it is made.
  void settle() { time_.reset(); }
  /// Returns what falls on its way to the decision's; unset if that has been reached.
  std::optional<FadingPrecipitation> fading() const;

 private:
  void take(const WeatherDecision& weather);

  std::optional<double> time_;
  FadingPrecipitation shown_;
  bool settled_ = true;
};

}  // namespace trimtab
