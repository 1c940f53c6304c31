#include "lever_places.h"

#include <algorithm>

namespace trimtab::tune {
namespace {

/// Returns the place of a value on straight lines between those of the list, over a scale on which they
/// ascend.
template <class Scale>
double between(const std::array<double, kLossSteps>& values, double value, const Scale& scale) {
  const double at = scale(value);
  if (at <= scale(values[0])) return 0;
  std::size_t step = 0;
  while (step + 1 < kLossSteps && scale(values[step + 1]) < at) ++step;
  if (step + 1 == kLossSteps) return kLossSteps - 1;
  return static_cast<double>(step) +
         (at - scale(values[step])) / (scale(values[step + 1]) - scale(values[step]));
}

/// Returns the place between two values of the list; -1 is a lever at rest.
double stepOf(Loss loss, double value) {
  const auto& values = kLossValues[static_cast<std::size_t>(loss)];
  switch (loss) {
    case Loss::ground_error:
    case Loss::object_error:
      return std::log2(value);
    case Loss::small_feature:
      return value < 1 ? value - 1 : std::log2(value);
    case Loss::object_distance:
      return std::log2(values[0] / value);
    case Loss::level_spread:
      // By the reciprocal, which is the power of the distance that the allowed error follows.
      return between(values, value, [](double v) { return -1 / v; });
    case Loss::blur:
      return value < values[0] ? value / values[0] - 1 : between(values, value, [](double v) { return v; });
    default:
      if (value >= values[0]) return values[0] < 1 ? -(value - values[0]) / (1 - values[0]) : 0;
      return between(values, value, [](double v) { return -v; });
  }
}

}  // namespace

double ladderSteps(double errorPx) {
  return double{kPlacesPerOctave} * std::log2(errorPx / kLeastPx);
}

Place onLadder(double steps) {
  const double at = std::clamp(steps, 0.0, static_cast<double>(kCounted - 1));
  const std::size_t low = std::min(static_cast<std::size_t>(at), kCounted - 2);
  return {low, at - static_cast<double>(low)};
}

Place onSteps(Loss loss, double value) {
  const double at = std::clamp(stepOf(loss, value), -1.0, static_cast<double>(kLossSteps - 1));
  if (at < 0) return {0, -at, true};
  const std::size_t low = std::min(static_cast<std::size_t>(at), kLossSteps - 2);
  return {low, at - static_cast<double>(low)};
}

}  // namespace trimtab::tune
