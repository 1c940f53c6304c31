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
  const double step = begun_ && std::isfinite(time) ? std::min(time - time_, kLongestStepS) : 0;
  for (std::size_t l = 0; l < kLevers; ++l) {
    const LeverRow& row = kLeverRows[l];
    const double wanted = std::isnan(targets.value[l]) ? neutral.value[l] : targets.value[l];
    const double target = std::clamp(wanted, row.hard.low, row.hard.high);
    double& value = values_.value[l];
    if (!begun_) {
      value = target;
      continue;
    }
    if (distance(row, value, target) > row.deadBand) moving_[l] = true;
    if (!moving_[l] || !(step > 0)) continue;
    value = moved(row, value, target, row.ratePerS * step);
    moving_[l] = value != target;
  }
  if (std::isfinite(time)) time_ = time, begun_ = true;
  return values_;
}

void LeverDrive::restart() {
  *this = {};
}

}  // namespace trimtab
