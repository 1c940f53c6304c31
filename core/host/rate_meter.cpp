#include "rate_meter.h"

#include <algorithm>
#include <cmath>

namespace trimtab {
namespace {

constexpr double kWindowS = 1;

}  // namespace

void RateMeter::arrived(double time) {
  times_[next_] = time;
  next_ = (next_ + 1) % kSize;
  count_ = std::min(count_ + 1, kSize);
}

double RateMeter::rateAt(double now) const {
  if (count_ < 2 || !(now - nth(0) < kWindowS)) return 0;
  // Binary search: arrival times do not fall, newest first.
  std::size_t inside = 1, outside = count_;
  while (inside < outside) {
    const std::size_t middle = (inside + outside) / 2;
    if (now - nth(middle) < kWindowS)
      inside = middle + 1;
    else
      outside = middle;
  }
  const double span = nth(0) - nth(inside - 1);
  return span > 0 ? static_cast<double>(inside - 1) / span : 0;
}

double RateMeter::meanGapS() const {
  constexpr std::size_t kEnough = 8;
  if (count_ < kEnough) return 0;
  const double rate = rateAt(nth(0));
  return rate > 0 ? 1 / rate : 0;
}

void RateMeter::deviated(double seconds) {
  constexpr double kGain = 1.0 / 16;
  jitter_ += (std::abs(seconds) - jitter_) * kGain;
}

}  // namespace trimtab
