#include "tried.h"

#include <algorithm>
#include <cmath>

namespace trimtab::tune {
namespace {

/// Returns how far apart the values are, of their largest.
double spreadOf(double least, double most) {
  return most > 0 ? (most - least) / most : 0;
}

double ratioOf(double drawn, double estimated) {
  return drawn > 0 && estimated > 0 && std::isfinite(drawn / estimated) ? drawn / estimated : 1;
}

}  // namespace

std::vector<std::size_t> rowsApart(std::span<const std::vector<RowEstimate>> estimates, std::size_t count) {
  if (estimates.empty()) return {};
  const std::size_t rows = estimates.front().size();
  count = std::min(count, rows);
  std::vector<std::size_t> apart;
  for (std::size_t span = 0; span < count; ++span) {
    double farthest = -1;
    std::size_t row = 0;
    for (std::size_t i = span * rows / count; i < (span + 1) * rows / count; ++i) {
      RowEstimate least = estimates.front()[i], most = least;
      for (const std::vector<RowEstimate>& preset : estimates) {
        least.ms = std::min(least.ms, preset[i].ms), most.ms = std::max(most.ms, preset[i].ms);
        least.error = std::min(least.error, preset[i].error),
        most.error = std::max(most.error, preset[i].error);
      }
      const double far = spreadOf(least.ms, most.ms) + spreadOf(least.error, most.error);
      if (far > farthest) farthest = far, row = least.row;
    }
    apart.push_back(row);
  }
  return apart;
}

Missed missedBy(ErrorKind kind, std::span<const RowEstimate> estimates,
                std::span<const harness::MeasuredFrame> drawn) {
  double estimatedMs = 0, drawnMs = 0;
  std::vector<double> estimatedErrors, drawnErrors;
  for (const harness::MeasuredFrame& frame : drawn)
    for (const RowEstimate& estimate : estimates) {
      if (estimate.row != frame.row) continue;
      estimatedMs += estimate.ms, drawnMs += frame.cost.total;
      const double error = frame.error.*rowOf(kind).ofImage;
      if (!std::isfinite(error)) continue;
      estimatedErrors.push_back(estimate.error), drawnErrors.push_back(error);
    }
  if (drawnErrors.empty()) return {ratioOf(drawnMs, estimatedMs), 1};
  return {ratioOf(drawnMs, estimatedMs),
          ratioOf(errorOfImages(kind, drawnErrors), errorOfImages(kind, estimatedErrors))};
}

}  // namespace trimtab::tune
