#include "front.h"

#include <algorithm>
#include <cmath>

#include "trimtab/measure/paired_ratio.h"

namespace trimtab::harness {
namespace {

bool isMeasured(const Results& results, const Quantity& quantity) {
  return std::any_of(results.units.begin(), results.units.end(),
                     [&](const Unit& unit) { return !std::isnan(summarise(unit, quantity).median); });
}

/// Returns the mean that represents a unit, or the median if the mean is not finite.
double centreOf(const Summary& summary) {
  return std::isinf(summary.mean) ? summary.median : summary.mean;
}

/// Returns the errors that frame time is compared with: those of the image's geometry if any was measured, or
/// else all others.
std::vector<const Quantity*> errorsOf(const Results& results) {
  std::vector<const Quantity*> errors;
  for (const char* key : {"flip", "geometric_mean_px", "geometric_max_px"})
    if (isMeasured(results, *quantityOf(key))) errors.push_back(quantityOf(key));
  if (!errors.empty()) return errors;
  for (const Quantity& q : quantities())
    if (q.kind == Quantity::Kind::error && !q.whole && q.largerIsWorse && isMeasured(results, q))
      errors.push_back(&q);
  return errors;
}

Front frontOf(const Results& results, const std::string& flight, const Quantity& error) {
  Front front{flight, &error, false, {}};
  std::vector<std::size_t> units;
  std::vector<double> lost, ms;
  std::vector<std::vector<double>> errors;
  for (std::size_t u = 0; u < results.units.size(); ++u) {
    const Unit& unit = results.units[u];
    const double x = centreOf(summarise(unit, error));
    const double y = summarise(unit, *quantityOf("frame_ms")).median;
    if (unit.name.flight != flight || !std::isfinite(x) || !std::isfinite(y)) continue;
    units.push_back(u);
    lost.push_back(x);
    ms.push_back(y);
    errors.emplace_back();
    for (const MeasuredFrame& frame : unit.frames) errors.back().push_back(error.of(frame));
  }
  front.known = !units.empty() && medianIntervalRank(results.units[units.front()].frames.size()) > 0;
  if (!front.known) return front;
  const auto beats = [&](std::size_t i, std::size_t j) {
    const PairedRatio times = frameTimeRatio(results.units[units[i]], results.units[units[j]]);
    return isBetterInBoth(differenceOf(times), errorDifference(errors[i], errors[j]));
  };
  for (const std::size_t i : trimtab::frontOf(lost, ms, beats)) front.units.push_back(units[i]);
  return front;
}

}  // namespace

std::vector<Front> frontsOf(const Results& results) {
  std::vector<Front> fronts;
  const std::vector<const Quantity*> errors = errorsOf(results);
  for (const Unit& unit : results.units) {
    const std::string& flight = unit.name.flight;
    if (std::any_of(fronts.begin(), fronts.end(), [&](const Front& f) { return f.flight == flight; }))
      continue;
    for (const Quantity* error : errors) fronts.push_back(frontOf(results, flight, *error));
  }
  return fronts;
}

}  // namespace trimtab::harness
