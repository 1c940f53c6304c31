#pragma once

#include <array>
#include <cstddef>
#include <optional>

namespace trimtab {

/// The average rate of recent images: what document C's Eq. (1) calls the average FPS.
class ImageRate {
 public:
  /// Adds an image at `now`, in seconds. A clock that does not go on begins the average anew.
  void add(double now);
  /// Returns images a second over the last quarter of a second, or over the last 256 images if they took
  /// less; nothing if that holds fewer than two. A longer average would for long remember the images that
  /// were drawn on demand while nothing moved, and would call the beginning of a turn slow.
  std::optional<double> perS() const;

 private:
  static constexpr double kWindowS = 0.25;
  std::array<double, 256> times_{};
  std::size_t next_ = 0, count_ = 0;
};

}  // namespace trimtab
