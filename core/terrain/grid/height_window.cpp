#include "trimtab/terrain/grid/height_window.h"

#include <algorithm>

namespace trimtab::terrain {
namespace {

template <class Value>
void copyWindow(const Value* values, std::uint32_t columns, const PostWindow& window, std::uint32_t stride,
                Value* out) {
  for (std::uint32_t r = 0; r < window.rows; r += stride) {
    const Value* row = values + std::size_t{window.row + r} * columns + window.column;
    for (std::uint32_t c = 0; c < window.columns; c += stride) *out++ = row[c];
  }
}

}  // namespace

void GridHeights::read(const PostWindow& window, std::uint32_t stride, std::span<float> heights) const {
  copyWindow(grid_.heights.data(), grid_.posts.columns, window, stride, heights.data());
}

void GridHeights::readVoids(const PostWindow& window, std::uint32_t stride,
                            std::span<std::uint8_t> voids) const {
  if (voids_.empty())
    std::fill(voids.begin(), voids.end(), std::uint8_t{0});
  else
    copyWindow(voids_.data(), grid_.posts.columns, window, stride, voids.data());
}

}  // namespace trimtab::terrain
