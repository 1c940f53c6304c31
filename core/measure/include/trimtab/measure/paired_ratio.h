#pragma once

#include <cstddef>
#include <span>

namespace trimtab {

/// The median of b/a over pairs that were measured one after the other, and the interval that holds the true
/// median with at least 95 % confidence (order statistics of the binomial distribution: nothing is assumed of
/// the noise but that pairs are independent). Of an even number of pairs the median is the geometric mean of
/// the middle two, so that a/b has exactly the reciprocals. NaN where there are no pairs; below six pairs no
/// interval is sure enough, and it is 0 to infinity.
struct PairedRatio {
  double median = 0, low = 0, high = 0;
  std::size_t pairs = 0;
};

/// Pairs in which either is not finite, `a` is not above 0 or `b` is below 0 do not count.
PairedRatio pairedRatio(std::span<const double> a, std::span<const double> b);

/// How many of `n` sorted values are cut off at either end of that interval; none where n is too small.
std::size_t medianIntervalCut(std::size_t n);

}  // namespace trimtab
