#pragma once

#include <cstddef>
#include <span>

namespace trimtab {

/// The median of b/a over pairs that were measured one after the other, and the interval that holds the true
/// median with at least 95 % confidence. The interval comes from order statistics of the binomial
/// distribution, which assume of the noise only that pairs are independent. The median of an even number of
/// pairs is the geometric mean of the middle two, so that a/b has exactly the reciprocals. Without pairs all
/// are NaN; below six pairs no interval is sure enough, and it is 0 to infinity.
struct PairedRatio {
  double median = 0, low = 0, high = 0;
  std::size_t pairs = 0;
};

/// Computes it. A pair does not count if either is not finite, if `a` is not above 0, or if `b` is below 0.
PairedRatio pairedRatio(std::span<const double> a, std::span<const double> b);

/// The same for differences b - a: their median (the mean of the middle two for an even number of pairs) with
/// its interval. Without pairs all are NaN; below six pairs the interval is -infinity to infinity.
struct PairedDifference {
  double median = 0, low = 0, high = 0;
  std::size_t pairs = 0;
};

/// Computes it. A pair does not count if either is not finite.
PairedDifference pairedDifference(std::span<const double> a, std::span<const double> b);

/// Returns how many of `n` sorted values that interval leaves out at either end; nothing if n is too small.
std::size_t medianIntervalCut(std::size_t n);

}  // namespace trimtab
