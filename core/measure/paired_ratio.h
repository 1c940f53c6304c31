#pragma once

#include <span>

namespace trimtab {

/// The median of b/a over pairs that were measured one after the other, and the interval that holds the true
/// median with 95 % confidence (order statistics of the binomial distribution: nothing is assumed of the
/// noise but that pairs are independent). NaN where there are no pairs; the interval is infinite below six.
struct PairedRatio {
  double median = 0, low = 0, high = 0;
  std::size_t pairs = 0;
};

/// Pairs in which either is not finite or `a` is not above 0 do not count.
PairedRatio pairedRatio(std::span<const double> a, std::span<const double> b);

}  // namespace trimtab
