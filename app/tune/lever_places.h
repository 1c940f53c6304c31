#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

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
/// The part of the triangles that each spread of levels leaves, at every octave of the ladder.
using SpreadKept = std::array<Steps, kCounted / kPlacesPerOctave + 1>;

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

/// The places of the levers in what the rows say.
struct Places {
  LeverPlace ground, objects;  ///< on the ladder
  std::array<LeverPlace, kLosses> losses;

  const Place& of(Loss loss, double value) {
    return losses[static_cast<std::size_t>(loss)].at(value, [loss](double v) { return onSteps(loss, v); });
  }
  static Place ladderPlace(double errorPx) { return onLadder(ladderSteps(errorPx)); }
};

/// Says which levels a preset draws at its levers.
struct LevelRule {
  bool trees = false;               ///< the ground is drawn as static trees
  std::optional<double> fixedPx{};  ///< the trees' rule allows this error, whatever the levers say
  /// A spread from another distance than the one that samples are drawn with is as if the allowed error were
  /// so many times as large; 1 without a spread.
  double fromTimes = 1;

  double groundPx(const FrameLevers& levers) const {
    return (fixedPx ? *fixedPx : trees ? levers.treeErrorPx : levers.errorPx) * levers.lodScale * fromTimes;
  }
  double objectPx(const FrameLevers& levers) const {
    return levers.objectErrorPx * levers.lodScale * fromTimes;
  }
  /// Returns the part of the triangles that the levers' spread leaves at a place of the ladder, in its steps.
  static double kept(const FrameLevers& levers, double steps, const SpreadKept& ofRow, Places& places) {
    if (levers.levelSpread == 1) return 1;
    const double octaves = std::clamp(steps, 0.0, double{kCounted - 1}) / double{kPlacesPerOctave};
    const auto low = std::min(static_cast<std::size_t>(octaves), ofRow.size() - 2);
    const Place& spread = places.of(Loss::level_spread, levers.levelSpread);
    return std::lerp(spread.in(ofRow[low]), spread.in(ofRow[low + 1]), octaves - static_cast<double>(low));
  }
  /// Returns what the allowed error is multiplied by to lose as much without the levers' spread.
  static double loses(const FrameLevers& levers, const Steps& ofRow, Places& places) {
    return levers.levelSpread == 1 ? 1
                                   : std::exp2(places.of(Loss::level_spread, levers.levelSpread).in(ofRow));
  }
};

}  // namespace trimtab::tune
