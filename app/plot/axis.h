#pragma once

#include <string>
#include <vector>

namespace trimtab::plot {

struct Tick {
  double value = 0;
  std::string text;
};

/// Maps values to places along an axis, from 0 to 1, with round ends. On a logarithmic axis, values of 0 and
/// below are in a band before the first tick.
class Axis {
 public:
  Axis() : Axis(even(0, 1, true)) {}
  /// Makes an axis with about `steps` round steps. With `fromZero`, it includes 0.
  static Axis even(double low, double high, bool fromZero, int steps = 5);
  /// Makes an axis with exactly these ends and round steps between.
  static Axis exactly(double low, double high);
  static Axis categories(std::size_t count);
  /// Makes a logarithmic axis; `low` must be above 0. With `zero`, it has a band for values of 0 and below.
  static Axis logarithmic(double low, double high, bool zero);
  /// Makes an axis that fits `values`; values that are not finite are ignored.
  static Axis of(const std::vector<double>& values, bool logarithmic, bool fromZero, int steps = 5);

  /// Leaves a fraction of the length free at each end, so that marks do not touch the frame.
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
