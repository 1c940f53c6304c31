#include "trimtab/policy/lever_drive.h"

#include <algorithm>
#include <cmath>

namespace trimtab {
namespace {

constexpr double kLongestStepS = 0.25;

double distance(const LeverRow& row, double from, double to) {
  return std::abs(row.logarithmic ? std::log2(to / from) : to - from);
}

/// Returns `from` moved towards `to` by at most `by`, in octaves or units.
double moved(const LeverRow& row, double from, double to, double by) {
  if (distance(row, from, to) <= by) return to;
  if (!row.logarithmic) return to > from ? from + by : from - by;
  return to > from ? from * std::exp2(by) : from * std::exp2(-by);
}

}  // namespace

const LeverValues& LeverDrive::follow(double time, const LeverValues& targets, const LeverValues& neutral) {
  State& s = state_;
  const double step = s.begun && std::isfinite(time) ? std::min(time - s.timeS, kLongestStepS) : 0;
  for (std::size_t l = 0; l < kLevers; ++l) {
    const LeverRow& row = kLeverRows[l];
    const std::uint32_t bit = 1u << l;
    // The preset may ask for what rules may not.
    const double target = std::isnan(targets.value[l])
                              ? neutral.value[l]
                              : std::clamp(targets.value[l], row.hard.low, row.hard.high);
    double& value = s.values.value[l];
    if (!s.begun) {
      value = target;
      continue;
    }
    // A lever that rests where it is to be needs no logarithm.
    if (value == target && !(s.moving & bit)) continue;
    if (distance(row, value, target) > row.deadBand) s.moving |= bit;
    if (!(s.moving & bit) || !(step > 0)) continue;
    value = moved(row, value, target, row.ratePerS * step);
    if (value == target) s.moving &= ~bit;
  }
  if (std::isfinite(time)) s.timeS = time, s.begun = true;
  return s.values;
}

}  // namespace trimtab
