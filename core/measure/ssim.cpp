#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <vector>

#include "image_kernels.h"
#include "picture_span.h"
#include "trimtab/measure/image_error.h"
#include "trimtab/units/not_finite.h"

namespace trimtab {
namespace {

constexpr int kWindow = 11, kStrip = 256;
constexpr std::size_t kPitch = kStrip + kSimdSlack;

SsimFilter gaussian() {
  std::array<double, 6> weights{};
  double sum = 0;
  for (int k = 0; k <= 5; ++k) {
    weights[static_cast<std::size_t>(k)] = std::exp(-k * k / (2 * 1.5 * 1.5));
    sum += (k == 0 ? 1 : 2) * weights[static_cast<std::size_t>(k)];
  }
  SsimFilter filter;
  for (std::size_t k = 0; k <= 5; ++k) filter.weights[k] = static_cast<float>(weights[k] / sum);
  return filter;
}

/// The last eleven rows of a strip, filtered along the row when a window needs them.
class Rows {
 public:
  Rows(const std::uint8_t* a, const std::uint8_t* b, int width, int column, int columns)
      : a_(a),
        b_(b),
        width_(static_cast<std::size_t>(width)),
        column_(static_cast<std::size_t>(column)),
        columns_(columns),
        planes_(kWindow * kSsimPlanes * kPitch) {}

  void enter(int row) {
    const std::size_t from = static_cast<std::size_t>(row) * width_ + column_;
    const auto bytes = static_cast<std::size_t>(columns_ + kWindow - 1);
    filtered_[slot(row)] = false;
    if (std::memcmp(a_ + from, b_ + from, bytes) != 0) lastDifferent_ = row;
  }
  /// Reports whether the rows from this one on are equal in both images.
  bool equalFrom(int row) const { return lastDifferent_ < row; }

  const float* planes(int row, const SsimFilter& filter) {
    float* planes = planes_.data() + slot(row) * kSsimPlanes * kPitch;
    if (!filtered_[slot(row)]) {
      const std::size_t from = static_cast<std::size_t>(row) * width_ + column_;
      imageKernels().ssimRow(a_ + from, b_ + from, columns_, filter, planes, kPitch);
      filtered_[slot(row)] = true;
    }
    return planes;
  }

 private:
  static std::size_t slot(int row) { return static_cast<std::size_t>(row % kWindow); }

  const std::uint8_t *a_, *b_;
  std::size_t width_, column_;
  int columns_, lastDifferent_ = -1;
  std::vector<float> planes_;
  std::array<bool, kWindow> filtered_{};
};

}  // namespace

double ssim(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b, int width, int height) {
  if (!holdsPicture(a, width, height, 1) || !holdsPicture(b, width, height, 1)) return kNan;
  const int columns = width - kWindow + 1, rows = height - kWindow + 1;
  if (columns <= 0 || rows <= 0) return kNan;
  const SsimFilter filter = gaussian();
  double total = 0;
  for (int column = 0; column < columns; column += kStrip) {
    const int count = std::min(kStrip, columns - column);
    Rows strip(a.data(), b.data(), width, column, count);
    for (int row = 0; row < kWindow - 1; ++row) strip.enter(row);
    for (int row = 0; row < rows; ++row) {
      strip.enter(row + kWindow - 1);
      if (strip.equalFrom(row)) {
        total += count;
        continue;
      }
      std::array<const float*, kWindow> window;
      for (int k = 0; k < kWindow; ++k) window[static_cast<std::size_t>(k)] = strip.planes(row + k, filter);
      total += imageKernels().ssimSum(window.data(), kPitch, count, filter);
    }
  }
  return total / (static_cast<double>(columns) * rows);
}

double ssimOfLuma(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b, int width, int height) {
  if (!holdsPicture(a, width, height, 4) || !holdsPicture(b, width, height, 4)) return kNan;
  const std::size_t pixels = a.size() / 4;
  std::vector<std::uint8_t> luma(2 * pixels);
  imageKernels().luma(a.data(), pixels, luma.data());
  imageKernels().luma(b.data(), pixels, luma.data() + pixels);
  const std::span<const std::uint8_t> both = luma;
  return ssim(both.first(pixels), both.last(pixels), width, height);
}

}  // namespace trimtab
