#pragma once

#include <array>
#include <cstddef>

namespace trimtab {

/// Arrival rate over the last second and RFC 3550 jitter. No allocation.
class RateMeter {
 public:
  void arrived(double time);
  /// Datagrams a second among those of the second before `now`.
  double rateAt(double now) const;
  /// Returns the mean gap behind rateAt(), 0 while fewer than eight have come.
  double meanGapS() const;
  /// D(i-1, i) of RFC 3550, 6.4.1: how much the gap between two arrivals differs from that between their
  /// sendings.
  void deviated(double seconds);
  double jitterS() const { return jitter_; }
  /// Begins again after a silence: rates start over, jitter stays.
  void restart() { count_ = 0; }

 private:
  double nth(std::size_t newest) const { return times_[(next_ + kSize - 1 - newest) % kSize]; }

  static constexpr std::size_t kSize = 1024;
  std::array<double, kSize> times_{};
  std::size_t next_ = 0, count_ = 0;
  double jitter_ = 0;
};

}  // namespace trimtab
