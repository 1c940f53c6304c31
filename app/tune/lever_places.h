#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "drawn_samples.h"
#include "trimtab/hold/load_counter.h"
#include "trimtab/units/not_finite.h"

/// Reads lists of numbers at values between those that were counted or drawn.
namespace trimtab::tune {

/// The ladder that is counted of each row: from half a pixel over seven octaves.
inline constexpr double kLeastPx = 0.5;
inline constexpr std::size_t kCounted = 7 * kPlacesPerOctave + 1;
using Counted = std::array<float, kCounted>;
/// What the steps of a loss say.
using Steps = std::array<float, kLossSteps>;

/// A place in a list: so far from a number to the next.
struct Place {
  std::size_t low = 0;
  double part = 0;
  bool first = false;  ///< `part` is the way to the first number from what the list says of a lever at rest

  template <class List>
  double in(const List& list) const {
    return std::lerp(static_cast<double>(list[low]), static_cast<double>(list[low + 1]), part);
  }
  double in(const Steps& steps, double atRest) const {
    return first ? std::lerp(static_cast<double>(steps[0]), atRest, part) : in(steps);
  }
};

/// Returns where an allowed error, pixels, lies on the ladder, in its steps; it may lie beyond an end.
double ladderSteps(double errorPx);
/// Returns the place so many steps up the ladder; beyond its ends, the end.
Place onLadder(double steps);
/// Returns where a value lies among the steps of a loss: on straight lines between the values that were
/// drawn, over the logarithm of errors and distances.
Place onSteps(Loss loss, double value);

/// Finds the places of one lever's values, and remembers the last: levers mostly rest from row to row.
class LeverPlace {
 public:
  template <class Find>
  const Place& at(double value, const Find& find) {
    if (value != value_) value_ = value, place_ = find(value);
    return place_;
  }

 private:
  double value_ = kNan;
  Place place_;
};

}  // namespace trimtab::tune
