#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <new>
#include <vector>

#include "flip_filters.h"
#include "image_kernels.h"
#include "picture_span.h"
#include "trimtab/measure/image_error.h"

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

/// Returns where two runs of pixels differ.
Columns difference(const std::uint8_t* a, const std::uint8_t* b, int pixels) {
  const auto equalAt = [&](int x) { return std::memcmp(a + 4 * x, b + 4 * x, 4) == 0; };
  if (std::memcmp(a, b, 4 * static_cast<std::size_t>(pixels)) == 0) return {};
  int from = 0, to = pixels;
  while (equalAt(from)) ++from;
  while (equalAt(to - 1)) --to;
  return {from, to};
}

/// Memory from the beginning of a cache line, so that whole vectors lie in one.
template <class T>
struct CacheLines {
  using value_type = T;
  static constexpr std::align_val_t kLine{64};
  T* allocate(std::size_t count) { return static_cast<T*>(::operator new(count * sizeof(T), kLine)); }
  void deallocate(T* memory, std::size_t) { ::operator delete(memory, kLine); }
  friend bool operator==(CacheLines, CacheLines) { return true; }
};
using Floats = std::vector<float, CacheLines<float>>;

int blocksFor(int columns) {
  return (columns + kFlipBlock - 1) / kFlipBlock;
}

/// FLIP of a strip of columns, a few rows at a time from the top. A row is converted to opponent colours and
/// filtered along the row when a window first needs it, and the result kept in a ring, block by block, so
/// that the vertical pass over a block reads what the nearest cache holds. Where the images are equal
/// within the filters' reach, nothing is computed: the error is 0.
class Strip {
 public:
  Strip(const Pictures& pictures, const FlipFilterBank& bank, int column, int columns)
      : pictures_(pictures),
        filters_(bank.filters()),
        radius_(bank.radius()),
        column_(column),
        columns_(columns),
        slots_(std::min(2 * radius_ + kRows, pictures.height)),
        blockPitch_(static_cast<std::size_t>(slots_) * kFlipBlockRow),
        lead_(blocksFor(radius_) * kFlipBlock),
        pitch_(static_cast<std::size_t>(lead_ + blocksFor(columns + radius_ + kSimdSlack) * kFlipBlock)),
        planes_(kFlipPlanes * pitch_),
        filtered_(static_cast<std::size_t>(blocksFor(columns)) * blockPitch_),
        rows_(static_cast<std::size_t>(slots_)),
        rowOffset_(static_cast<std::size_t>(2 * radius_ + kRows)) {}

  /// Adds the errors of all rows; they are written to `map`, of the image's width, unless it is null.
  double sum(float* map) {
    double total = 0;
    int entered = 0;
    for (int row = 0; row < pictures_.height; row += kRows) {
      const int rows = std::min(kRows, pictures_.height - row);
      while (entered < std::min(row + rows + radius_, pictures_.height)) enter(entered++);
      float* out = map ? map + at(row, column_) : nullptr;
      const Columns seen = errorColumns(row, rows);
      if (out)
        for (int i = 0; i < rows; ++i) {
          float* line = out + at(i, 0);
          std::fill(line, line + seen.from, 0.0f);
          std::fill(line + seen.to, line + columns_, 0.0f);
        }
      if (!seen.empty()) total += rowsSum(row, rows, seen, out);
    }
    return total;
  }

 private:
  static constexpr int kRows = 8;

  struct Row {
    Columns differs;   ///< of the strip, reaching beyond it by the radius
    Columns filtered;  ///< blocks
  };

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
    rows_[slot(row)] = {found, {}};
  }

  /// Columns of the strip where these rows' errors see a difference, from the beginning of a block.
  Columns errorColumns(int row, int rows) const {
    Columns all;
    for (int y = std::max(0, row - radius_); y < std::min(pictures_.height, row + rows + radius_); ++y)
      all.include(rows_[slot(y)].differs);
    if (all.empty()) return {0, 0};
    const int from = std::clamp(all.from - radius_, 0, columns_);
    return {from / kFlipBlock * kFlipBlock, std::clamp(all.to + radius_, 0, columns_)};
  }

  double rowsSum(int row, int rows, Columns seen, float* out) {
    const Columns blocks{seen.from / kFlipBlock, blocksFor(seen.to)};
    for (int k = -radius_; k < rows + rows % 2 + radius_; ++k) {  // the kernel takes rows by twos
      const int y = std::clamp(row + k, 0, pictures_.height - 1);
      filter(y, blocks);
      rowOffset_[static_cast<std::size_t>(k + radius_)] = slot(y) * kFlipBlockRow;
    }
    return imageKernels().flipError(filtered_.data() + static_cast<std::size_t>(blocks.from) * blockPitch_,
                                    blockPitch_, rowOffset_.data() + radius_, rows, seen.to - seen.from,
                                    filters_, out ? out + seen.from : nullptr,
                                    static_cast<std::size_t>(pictures_.width));
  }

  /// Sees to it that these blocks of a row are filtered.
  void filter(int row, Columns blocks) {
    Columns& done = rows_[slot(row)].filtered;
    if (done.empty()) {
      filterBlocks(row, blocks);
      done = blocks;
      return;
    }
    if (blocks.from < done.from) filterBlocks(row, {blocks.from, done.from});
    if (blocks.to > done.to) filterBlocks(row, {done.to, blocks.to});
    done.include(blocks);
  }

  void filterBlocks(int row, Columns blocks) {
    const int first = column_ + blocks.from * kFlipBlock, pixels = (blocks.to - blocks.from) * kFlipBlock;
    const int from = std::max(0, first - radius_);
    const int to = std::min(pictures_.width, first + pixels + radius_);
    const ImageKernels& kernels = imageKernels();
    float* middle = planes_.data() + lead_;
    kernels.flipConvert(pictures_.reference + 4 * at(row, from), pictures_.test + 4 * at(row, from),
                        to - from, flipTable(), middle + (from - first), pitch_);
    // Beyond the image its border repeats.
    for (std::size_t p = 0; p < kFlipPlanes; ++p) {
      float* plane = middle + p * pitch_;
      std::fill(plane - radius_, plane + (from - first), plane[from - first]);
      std::fill(plane + (to - first), plane + pixels + radius_, plane[to - first - 1]);
    }
    kernels.flipHorizontal(
        middle, pitch_, blocks.to - blocks.from, filters_,
        filtered_.data() + static_cast<std::size_t>(blocks.from) * blockPitch_ + slot(row) * kFlipBlockRow,
        blockPitch_);
  }

  Pictures pictures_;
  const FlipFilters& filters_;
  int radius_, column_, columns_, slots_;
  std::size_t blockPitch_;
  int lead_;
  std::size_t pitch_;
  Floats planes_, filtered_;
  std::vector<Row> rows_;
  std::vector<std::size_t> rowOffset_;
};

}  // namespace

double flip(std::span<const std::uint8_t> reference, std::span<const std::uint8_t> test, int width,
            int height, std::span<float> map, double pixelsPerDegree) {
  constexpr int kStripColumns = 128;
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
