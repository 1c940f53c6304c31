#pragma once

#include <cmath>
#include <optional>

namespace trimtab {

/// Maps our clock to the host's, for Extrapolator::at(). Seconds throughout. Call follow() for each state, in
/// order of arrival.
class HostClockOffset {
 public:
  void follow(double hostTime, double arrival) {
    const double offset = hostTime - arrival;
    const bool steps = !offset_ || !(std::abs(offset - *offset_) <= kStepS);
    offset_ = steps ? offset : *offset_ + (offset - *offset_) * kGain;
  }
  /// Returns the host's time at `now` of our clock; `now` itself before the first state.
  double hostTime(double now) const { return now + offset_.value_or(0); }
  void restart() { offset_.reset(); }

 private:
  /// A step of the host's clock against ours that is not jitter: pause, restart, another speed.
  static constexpr double kStepS = 0.25;
  /// Share of a packet's clock difference that is believed at once; smooths the eye against arrival jitter.
  static constexpr double kGain = 0.05;
  std::optional<double> offset_;
};

}  // namespace trimtab
