#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "flip_filters.h"
#include "image_error.h"
#include "picture_span.h"
#include "simd_kernels.h"

namespace trimtab {
namespace {

/// Columns of pixels, empty where `from` is not below `to`.
struct Columns {
  int from = std::numeric_limits<int>::max(), to = 0;
  void include(Columns other) {
    from = std::min(from, other.from);
    to = std::max(to, other.to);
  }
  bool empty() const { return from >= to; }
};

struct Pictures {
  const std::uint8_t *reference, *test;
  int width, height;
};

/// Where two runs of pixels differ.
Columns difference(const std::uint8_t* a, const std::uint8_t* b, int pixels) {
  const auto equalAt = [&](int x) { return std::memcmp(a + 4 * x, b + 4 * x, 4) == 0; };
  if (std::memcmp(a, b, 4 * static_cast<std::size_t>(pixels)) == 0) return {};
  int from = 0, to = pixels;
  while (equalAt(from)) ++from;
  while (equalAt(to - 1)) --to;
  return {from, to};
}

/// FLIP of a strip of columns, from the top row down. Rows are converted to opponent colours when a window
/// first needs them and kept in a ring; the filtered planes of a row are used at once and never leave the
/// cache. Where the two pictures are equal within a filter's reach, nothing is computed: the error is 0.
class Strip {
 public:
  Strip(const Pictures& pictures, const FlipFilterBank& bank, int column, int columns)
      : pictures_(pictures),
        filters_(bank.filters()),
        radius_(bank.radius()),
        column_(column),
        columns_(columns),
        slots_(std::min(2 * radius_ + 1, pictures.height)),
        pitch_(static_cast<std::size_t>(columns + 2 * radius_ + kSimdSlack)),
        ring_(static_cast<std::size_t>(slots_) * kFlipPlanes * pitch_),
        filtered_(kFlipFilteredPlanes * pitch_),
        differs_(static_cast<std::size_t>(slots_)),
        converted_(static_cast<std::size_t>(slots_)),
        window_(static_cast<std::size_t>(2 * radius_ + 1)) {}

  /// Adds the errors of all rows; they are written to `map`, of the picture's width, unless it is null.
  double sum(float* map) {
    double total = 0;
    for (int row = 0; row < std::min(radius_, pictures_.height); ++row) enter(row);
    for (int row = 0; row < pictures_.height; ++row) {
      if (row + radius_ < pictures_.height) enter(row + radius_);
      float* out = map ? map + at(row, column_) : nullptr;
      const Columns seen = errorColumns(row);
      if (out) {
        std::fill(out, out + seen.from, 0.0f);
        std::fill(out + seen.to, out + columns_, 0.0f);
      }
      if (!seen.empty()) total += rowSum(row, seen, out);
    }
    return total;
  }

 private:
  std::size_t at(int row, int column) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(pictures_.width) +
           static_cast<std::size_t>(column);
  }
  std::size_t slot(int row) const { return static_cast<std::size_t>(row % slots_); }

  void enter(int row) {
    const int from = std::max(0, column_ - radius_);
    const int to = std::min(pictures_.width, column_ + columns_ + radius_);
    const std::size_t start = 4 * at(row, from);
    Columns found = difference(pictures_.reference + start, pictures_.test + start, to - from);
    if (!found.empty()) found = {found.from + from - column_, found.to + from - column_};
    differs_[slot(row)] = found;
    converted_[slot(row)] = false;
  }

  /// Columns of the strip that see a difference from this row.
  Columns errorColumns(int row) const {
    Columns all;
    for (int y = std::max(0, row - radius_); y <= std::min(pictures_.height - 1, row + radius_); ++y)
      all.include(differs_[slot(y)]);
    if (all.empty()) return {0, 0};
    return {std::clamp(all.from - radius_, 0, columns_), std::clamp(all.to + radius_, 0, columns_)};
  }

  double rowSum(int row, Columns seen, float* out) {
    for (int k = -radius_; k <= radius_; ++k)
      window_[static_cast<std::size_t>(k + radius_)] = planes(std::clamp(row + k, 0, pictures_.height - 1));
    const ImageKernels& kernels = imageKernels();
    kernels.flipVertical(window_.data() + radius_, pitch_, seen.from, seen.to + 2 * radius_, filters_,
                         filtered_.data());
    return kernels.flipError(filtered_.data(), pitch_, seen.from, seen.to, radius_, filters_, out);
  }

  /// A row's planes, which begin `radius_` columns before the strip; beyond the picture its border repeats.
  const float* planes(int row) {
    float* planes = ring_.data() + slot(row) * kFlipPlanes * pitch_;
    if (converted_[slot(row)]) return planes;
    converted_[slot(row)] = true;
    const int from = std::max(0, column_ - radius_);
    const int to = std::min(pictures_.width, column_ + columns_ + radius_);
    const int before = from - (column_ - radius_), pixels = to - from;
    imageKernels().flipConvert(pictures_.reference + 4 * at(row, from), pictures_.test + 4 * at(row, from),
                               pixels, flipTable(), planes + before, pitch_);
    for (std::size_t p = 0; p < kFlipPlanes; ++p) {
      float* plane = planes + p * pitch_;
      std::fill(plane, plane + before, plane[before]);
      std::fill(plane + before + pixels, plane + pitch_, plane[before + pixels - 1]);
    }
    return planes;
  }

  Pictures pictures_;
  const FlipFilters& filters_;
  int radius_, column_, columns_, slots_;
  std::size_t pitch_;
  std::vector<float> ring_, filtered_;
  std::vector<Columns> differs_;
  std::vector<char> converted_;
  std::vector<const float*> window_;
};

}  // namespace

double flip(std::span<const std::uint8_t> reference, std::span<const std::uint8_t> test, int width,
            int height, std::span<float> map, double pixelsPerDegree) {
  constexpr int kStripColumns = 256;
  const bool filterExists = pixelsPerDegree >= FlipFilterBank::kLeastPixelsPerDegree &&
                            pixelsPerDegree <= FlipFilterBank::kMostPixelsPerDegree;
  if (!filterExists || !holdsPicture(reference, width, height, 4) || !holdsPicture(test, width, height, 4) ||
      (!map.empty() && map.size() != reference.size() / 4))
    return std::numeric_limits<double>::quiet_NaN();
  const FlipFilterBank bank(pixelsPerDegree);
  const Pictures pictures{reference.data(), test.data(), width, height};
  double sum = 0;
  for (int column = 0; column < width; column += kStripColumns)
    sum += Strip(pictures, bank, column, std::min(kStripColumns, width - column))
               .sum(map.empty() ? nullptr : map.data());
  return sum / (static_cast<double>(width) * height);
}

}  // namespace trimtab
