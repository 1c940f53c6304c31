#pragma once

#include <string>
#include <vector>

namespace trimtab::plot {

struct Tick {
  double value = 0;
  std::string text;
};

/// Values to places along an axis, 0..1, at round ends. On a logarithmic axis values of 0 and below stand in
/// a band before the first tick.
class Axis {
 public:
  Axis() : Axis(even(0, 1, true)) {}
  /// Round steps, about `steps` of them. `fromZero`: 0 is on it.
  static Axis even(double low, double high, bool fromZero, int steps = 5);
  /// Ends where told, round steps between.
  static Axis exactly(double low, double high);
  static Axis categories(std::size_t count);
  /// `low` above 0.
  static Axis logarithmic(double low, double high, bool zero);
  /// Fit for `values`, of which not all need to be finite.
  static Axis of(const std::vector<double>& values, bool logarithmic, bool fromZero, int steps = 5);

  /// Leaves a part of the length free at its ends, so that marks do not stand on the frame.
  void widen(double atLow, double atHigh);

  double at(double value) const;
  const std::vector<Tick>& ticks() const { return ticks_; }
  double low() const { return low_; }
  double high() const { return high_; }

 private:
  Axis(double low, double high) : low_(low), high_(high) {}
  void tickEvenly(double step);

  double low_ = 0, high_ = 1;
  double begin_ = 0, length_ = 1;  ///< of the ticks' range, of the whole
  bool log_ = false, zero_ = false;
  std::vector<Tick> ticks_;
};

}  // namespace trimtab::plot
