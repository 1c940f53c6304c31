#include "trimtab/measure/image_shift.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "trimtab/measure/statistics.h"

namespace trimtab {
namespace {

constexpr int kBlock = 16;
/// A block is flat if its green differs by less than five steps of a byte from its mean: what fits then is as
/// much the rounding as the place.
constexpr double kFlat = 25;
/// A place fits if what is left of the squared difference is at most this part of the block's own contrast.
constexpr double kFits = 0.1;

class Shifts {
 public:
  Shifts(std::span<const std::uint8_t> reference, std::span<const std::uint8_t> test, int width, int window)
      : reference_(reference),
        test_(test),
        width_(width),
        window_(window),
        side_(2 * window + 1),
        cost_(static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_)) {}

  bool hasContrast(int x, int y) const { return contrastAt(x, y) >= kFlat; }
  /// Returns how far the block at x, y moved; NaN if it tells nothing.
  double of(int x, int y) {
    const double contrast = contrastAt(x, y);
    double least = std::numeric_limits<double>::infinity();
    for (int dy = -window_; dy <= window_; ++dy)
      for (int dx = -window_; dx <= window_; ++dx)
        least = std::min(least, at(dx, dy) = difference(x, y, dx, dy));
    if (least > kFits * contrast) return std::numeric_limits<double>::quiet_NaN();
    int bestX = 0, bestY = 0, nearest = std::numeric_limits<int>::max();
    for (int dy = -window_; dy <= window_; ++dy)
      for (int dx = -window_; dx <= window_; ++dx)
        if (at(dx, dy) <= least && dx * dx + dy * dy < nearest)
          nearest = dx * dx + dy * dy, bestX = dx, bestY = dy;
    if (least == 0 && nearest == 0) return 0;
    return std::hypot(bestX + between(bestX, [&](int d) { return at(d, bestY); }),
                      bestY + between(bestY, [&](int d) { return at(bestX, d); }));
  }

 private:
  double& at(int dx, int dy) {
    return cost_[static_cast<std::size_t>((dy + window_) * side_ + dx + window_)];
  }
  static double green(std::span<const std::uint8_t> image, int width, int x, int y) {
    return image[4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                      static_cast<std::size_t>(x)) +
                 1];
  }
  double contrastAt(int x, int y) const {
    double sum = 0, squares = 0;
    for (int j = 0; j < kBlock; ++j)
      for (int i = 0; i < kBlock; ++i) {
        const double value = green(reference_, width_, x + i, y + j);
        sum += value, squares += value * value;
      }
    constexpr double kPixels = kBlock * kBlock;
    return squares / kPixels - sum * sum / (kPixels * kPixels);
  }
  double difference(int x, int y, int dx, int dy) const {
    double sum = 0;
    for (int j = 0; j < kBlock; ++j)
      for (int i = 0; i < kBlock; ++i) {
        const double d =
            green(reference_, width_, x + i, y + j) - green(test_, width_, x + i + dx, y + j + dy);
        sum += d * d;
      }
    return sum / (kBlock * kBlock);
  }
  /// Returns how far the least of a parabola through three neighbouring values lies from the middle one.
  template <class Value>
  double between(int d, const Value& value) const {
    if (d <= -window_ || d >= window_) return 0;
    const double before = value(d - 1), here = value(d), after = value(d + 1);
    const double curve = before - 2 * here + after;
    return curve > 0 ? std::clamp((before - after) / (2 * curve), -0.5, 0.5) : 0;
  }

  std::span<const std::uint8_t> reference_, test_;
  int width_, window_, side_;
  std::vector<double> cost_;
};

}  // namespace

ImageShift imageShift(std::span<const std::uint8_t> reference, std::span<const std::uint8_t> test, int width,
                      int height, int windowPx) {
  ImageShift shift{std::numeric_limits<double>::quiet_NaN()};
  const auto bytes =
      static_cast<std::size_t>(std::max(width, 0)) * static_cast<std::size_t>(std::max(height, 0)) * 4;
  if (bytes == 0 || windowPx < 1 || reference.size() != bytes || test.size() != bytes) return shift;
  Shifts shifts(reference, test, width, windowPx);
  std::vector<double> told;
  int withContrast = 0;
  for (int y = windowPx; y + kBlock + windowPx <= height; y += kBlock)
    for (int x = windowPx; x + kBlock + windowPx <= width; x += kBlock)
      if (shifts.hasContrast(x, y)) {
        ++withContrast;
        if (const double px = shifts.of(x, y); !std::isnan(px)) told.push_back(px);
      }
  constexpr double kMoved = 0.1;
  shift.blocks = static_cast<int>(told.size());
  if (told.empty()) return shift;
  shift.told = static_cast<double>(told.size()) / withContrast;
  shift.moved = static_cast<double>(std::ranges::count_if(told, [](double px) { return px >= kMoved; })) /
                static_cast<double>(told.size());
  shift.p95Px = quantileOf(told, 0.95);
  return shift;
}

}  // namespace trimtab
