#include "trimtab/measure/paired_ratio.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <vector>

#include "trimtab/measure/statistics.h"
#include "trimtab/units/not_finite.h"

namespace trimtab {
namespace {

/// A ratio from this on is written as a multiple, and a smaller one as a percentage.
constexpr double kTwice = 1.995;

template <class Interval>
MeasuredDifference differenceFrom(const Interval& interval, double equality) {
  if (!std::isfinite(interval.low) || !std::isfinite(interval.high)) return MeasuredDifference::unknown;
  if (interval.high < equality) return MeasuredDifference::less;
  return interval.low > equality ? MeasuredDifference::more : MeasuredDifference::none;
}

}  // namespace

std::size_t medianIntervalRank(std::size_t n, double confidence) {
  return quantileRank(n, 0.5, (1 - confidence) / 2);
}

PairedRatio pairedRatio(std::span<const double> a, std::span<const double> b, double confidence) {
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
  const std::size_t rank = medianIntervalRank(n, confidence);
  result.low = rank > 0 ? ratios[rank - 1] : 0;
  result.high = rank > 0 ? ratios[n - rank] : kInfinity;
  return result;
}

PairedDifference pairedDifference(std::span<const double> a, std::span<const double> b, double confidence) {
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
  const std::size_t rank = medianIntervalRank(n, confidence);
  result.low = rank > 0 ? differences[rank - 1] : -kInfinity;
  result.high = rank > 0 ? differences[n - rank] : kInfinity;
  return result;
}

MeasuredDifference differenceOf(const PairedRatio& ratio) {
  return differenceFrom(ratio, 1);
}

MeasuredDifference differenceOf(const PairedDifference& difference) {
  return differenceFrom(difference, 0);
}

MeasuredDifference errorDifference(std::span<const double> a, std::span<const double> b, double confidence) {
  std::vector<double> differingA, differingB;
  std::size_t equal = 0;
  double sum = 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    if (!std::isfinite(a[i]) || !std::isfinite(b[i])) continue;
    if (a[i] == b[i]) {
      ++equal;
      continue;
    }
    differingA.push_back(a[i]);
    differingB.push_back(b[i]);
    sum += b[i] - a[i];
  }
  if (differingA.empty())
    return medianIntervalRank(equal, confidence) > 0 ? MeasuredDifference::none : MeasuredDifference::unknown;
  const MeasuredDifference found = differenceOf(pairedDifference(differingA, differingB, confidence));
  const bool agrees =
      found == MeasuredDifference::less ? sum < 0 : found != MeasuredDifference::more || sum > 0;
  return agrees ? found : MeasuredDifference::none;
}

std::string inWords(const PairedRatio& ratio) {
  if (ratio.pairs == 0) return "not measured";
  const MeasuredDifference difference = differenceOf(ratio);
  if (difference == MeasuredDifference::unknown) return "too few pairs to tell";
  if (difference == MeasuredDifference::none) return "no difference";
  char text[48];
  const double percent = std::abs(ratio.median - 1) * 100;
  if (ratio.median >= kTwice)
    std::snprintf(text, sizeof text, "%.3g times as long", ratio.median);
  else
    std::snprintf(text, sizeof text, "%.*f %% %s", percent < 10 ? 1 : 0, percent,
                  difference == MeasuredDifference::less ? "faster" : "slower");
  return text;
}

bool isBetterInBoth(MeasuredDifference first, MeasuredDifference second) {
  return (first == MeasuredDifference::more && second != MeasuredDifference::less) ||
         (second == MeasuredDifference::more && first != MeasuredDifference::less);
}

std::vector<std::size_t> frontOf(std::span<const double> x, std::span<const double> y,
                                 const std::function<bool(std::size_t, std::size_t)>& beats) {
  std::vector<std::size_t> order, excelled, front;
  for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i)
    if (std::isfinite(x[i]) && std::isfinite(y[i])) order.push_back(i);
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return x[a] != x[b] ? x[a] < x[b] : y[a] < y[b]; });
  for (const std::size_t i : order)
    if (excelled.empty() || y[i] < y[excelled.back()]) excelled.push_back(i);
  for (const std::size_t i : order)
    if (std::none_of(excelled.begin(), excelled.end(),
                     [&](std::size_t best) { return best != i && beats(best, i); }))
      front.push_back(i);
  return front;
}

}  // namespace trimtab
