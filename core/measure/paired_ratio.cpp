#include "trimtab/measure/paired_ratio.h"
#include "trimtab/units/not_finite.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <vector>

namespace trimtab {
namespace {

constexpr double kEachTail = 0.025;

}  // namespace

/// With the k-th smallest value as the lower end, the true median lies below it when at most k - 1 values
/// fell under the median: P(Bin(n, 1/2) <= k - 1). One value fewer is cut than ends are counted.
std::size_t medianIntervalCut(std::size_t n) {
  const double count = static_cast<double>(n);
  double tail = 0;
  for (std::size_t fewer = 0; fewer < n; ++fewer) {
    const double k = static_cast<double>(fewer);
    // The sum uses logarithms, because 2^-n is no double from 1,075 pairs on.
    tail += std::exp(std::lgamma(count + 1) - std::lgamma(k + 1) - std::lgamma(count - k + 1) -
                     count * std::numbers::ln2);
    if (tail > kEachTail) return fewer;
  }
  return 0;
}

PairedRatio pairedRatio(std::span<const double> a, std::span<const double> b) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    if (std::isfinite(a[i]) && std::isfinite(b[i]) && a[i] > 0 && b[i] >= 0) ratios.push_back(b[i] / a[i]);
  const std::size_t n = ratios.size();
  if (n == 0) return {kNan, kNan, kNan, 0};
  std::sort(ratios.begin(), ratios.end());
  const double below = ratios[(n - 1) / 2], above = ratios[n / 2];
  PairedRatio result;
  result.median = below == above ? below : std::sqrt(below) * std::sqrt(above);
  result.pairs = n;
  const std::size_t cut = medianIntervalCut(n);
  result.low = cut > 0 ? ratios[cut - 1] : 0;
  result.high = cut > 0 ? ratios[n - cut] : std::numeric_limits<double>::infinity();
  return result;
}

PairedDifference pairedDifference(std::span<const double> a, std::span<const double> b) {
  std::vector<double> differences;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    if (std::isfinite(a[i]) && std::isfinite(b[i])) differences.push_back(b[i] - a[i]);
  const std::size_t n = differences.size();
  if (n == 0) {
    return {kNan, kNan, kNan, 0};
  }
  std::sort(differences.begin(), differences.end());
  PairedDifference result;
  result.median = std::midpoint(differences[(n - 1) / 2], differences[n / 2]);
  result.pairs = n;
  const std::size_t cut = medianIntervalCut(n);
  result.low = cut > 0 ? differences[cut - 1] : -kInfinity;
  result.high = cut > 0 ? differences[n - cut] : kInfinity;
  return result;
}

}  // namespace trimtab
