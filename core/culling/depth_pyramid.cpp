#include "trimtab/culling/depth_pyramid.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace trimtab {
namespace {

/// Cells per side of the coarsest level, and of the level at which the test of a rectangle starts.
constexpr int kCoarsest = 8, kFirstCells = 3;

/// Depths are not negative, so their bits compare like integers, which compilers vectorise.
std::int32_t leastOf(const float* a, const float* b) {
  return std::min(std::bit_cast<std::int32_t>(*a), std::bit_cast<std::int32_t>(*b));
}

}  // namespace

void DepthPyramid::resize(int width, int height) {
  width_ = width;
  height_ = height;
  levels_.clear();
  std::size_t cells = 0;
  for (int w = width, h = height;; w = (w + 1) / 2, h = (h + 1) / 2) {
    levels_.push_back({cells, w, h});
    cells += static_cast<std::size_t>(w) * static_cast<std::size_t>(h);
    if (w <= kCoarsest && h <= kCoarsest) break;
  }
  cells_.resize(cells);
}

void DepthPyramid::build(std::span<const float> picture, int pictureWidth, int pictureHeight, int width,
                         int height) {
  resize(width, height);
  const auto from = [](int texel, int pixels, int texels) {
    return static_cast<int>(std::int64_t{texel} * pixels / texels);
  };
  const auto to = [](int texel, int pixels, int texels) {
    return std::min(static_cast<int>(((std::int64_t{texel} + 1) * pixels + texels - 1) / texels), pixels);
  };
  for (int y = 0; y < height; ++y) {
    const auto rowOf = [&](int pixelRow) {
      return picture.begin() + static_cast<std::ptrdiff_t>(pixelRow) * pictureWidth;
    };
    const int first = from(y, pictureHeight, height), last = to(y, pictureHeight, height);
    row_.assign(rowOf(first), rowOf(first) + pictureWidth);
    for (int pixelRow = first + 1; pixelRow < last; ++pixelRow) {
      const float* in = &*rowOf(pixelRow);
      for (std::size_t x = 0; x < row_.size(); ++x) row_[x] = in[x] < row_[x] ? in[x] : row_[x];
    }
    float* out = cells_.data() + static_cast<std::ptrdiff_t>(y) * width;
    for (int x = 0; x < width; ++x) {
      float farthest = row_[static_cast<std::size_t>(from(x, pictureWidth, width))];
      for (int i = from(x, pictureWidth, width) + 1, end = to(x, pictureWidth, width); i < end; ++i)
        farthest = std::min(farthest, row_[static_cast<std::size_t>(i)]);
      out[x] = farthest;
    }
  }
  reduce();
}

void DepthPyramid::reduce() {
  for (std::size_t i = 1; i < levels_.size(); ++i) {
    const Level &from = levels_[i - 1], &to = levels_[i];
    for (int y = 0; y < to.height; ++y) {
      const int below = 2 * y, above = std::min(2 * y + 1, from.height - 1);
      const float* low = cells_.data() + from.first + static_cast<std::ptrdiff_t>(below) * from.width;
      const float* high = cells_.data() + from.first + static_cast<std::ptrdiff_t>(above) * from.width;
      float* out = cells_.data() + to.first + static_cast<std::ptrdiff_t>(y) * to.width;
      const int pairs = from.width / 2;
      for (int x = 0; x < pairs; ++x) {
        const std::int32_t below2 = leastOf(low + 2 * x, low + 2 * x + 1),
                           above2 = leastOf(high + 2 * x, high + 2 * x + 1);
        out[x] = std::bit_cast<float>(std::min(below2, above2));
      }
      if (pairs < to.width) out[pairs] = std::bit_cast<float>(leastOf(low + 2 * pairs, high + 2 * pairs));
    }
  }
}

std::span<const float> DepthPyramid::depths() const {
  return {cells_.data(), static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_)};
}

bool DepthPyramid::covers(int x0, int y0, int x1, int y1, float limit) const {
  std::size_t level = 0;
  while (level + 1 < levels_.size() &&
         std::max((x1 >> level) - (x0 >> level), (y1 >> level) - (y0 >> level)) >= kFirstCells)
    ++level;
  return coversWithin(level, x0, y0, x1, y1, limit);
}

bool DepthPyramid::coversWithin(std::size_t level, int x0, int y0, int x1, int y1, float limit) const {
  const Level& l = levels_[level];
  // Whatever stands out above a ridge does so at its top, so the rows are tested from above.
  for (int y = y1 >> level; y >= y0 >> level; --y)
    for (int x = x0 >> level; x <= x1 >> level; ++x) {
      if (cells_[l.first + static_cast<std::size_t>(y) * static_cast<std::size_t>(l.width) +
                 static_cast<std::size_t>(x)] > limit)
        continue;
      if (level == 0) return false;
      // Two levels finer if possible: one level at a time costs more than it saves.
      const std::size_t finer = level == 1 ? 0 : level - 2;
      const int left = x << level, right = ((x + 1) << level) - 1, bottom = y << level,
                top = ((y + 1) << level) - 1;
      if (!coversWithin(finer, std::max(x0, left), std::max(y0, bottom), std::min(x1, right),
                        std::min(y1, top), limit))
        return false;
    }
  return true;
}

bool DepthPyramid::isHidden(const Box& box, const EyePose& eye, const ViewShape& view) const {
  const double across = view.right - view.left, upward = view.top - view.bottom;
  // Written so that an invalid view hides nothing: mirrored, without width, infinite, or not a number.
  if (width_ <= 0 || height_ <= 0 || !(across > 0 && upward > 0 && std::isfinite(across + upward)))
    return false;
  double lowX = 1e300, highX = -1e300, lowY = 1e300, highY = -1e300, nearest = 1e300;
  for (unsigned corner = 0; corner < 8; ++corner) {
    const Vec3 p = Vec3{corner & 1u ? box.maxX : box.minX, corner & 2u ? box.maxY : box.minY,
                        corner & 4u ? box.maxZ : box.minZ} -
                   eye.position;
    const Vec3 e = eye.axes * p;
    const double z = -e.z;
    // Written so that an eye that is not a number hides nothing.
    if (!(z > view.nearM * 1.01)) return false;
    nearest = std::min(nearest, z);
    lowX = std::min(lowX, e.x / z);
    highX = std::max(highX, e.x / z);
    lowY = std::min(lowY, e.y / z);
    highY = std::max(highY, e.y / z);
  }
  // Widened by a pixel and a bit, because rasterisers snap vertices and floats relative to the eye are
  // rounded.
  const auto texels = [](double tangent, double from, double to, int map, int picture, double pad) {
    const double at = (tangent - from) / (to - from) * map + pad * (1.5 * map / picture + 0.01);
    return static_cast<int>(std::clamp(std::floor(at), 0.0, map - 1.0));
  };
  return covers(texels(lowX, view.left, view.right, width_, view.widthPx, -1),
                texels(lowY, view.bottom, view.top, height_, view.heightPx, -1),
                texels(highX, view.left, view.right, width_, view.widthPx, 1),
                texels(highY, view.bottom, view.top, height_, view.heightPx, 1),
                static_cast<float>(view.nearM / nearest * 1.0001));
}

}  // namespace trimtab
