#include "trimtab/culling/depth_pyramid.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace trimtab {
namespace {

/// Texels a side that are looked at: more see more hidden, and cost more.
constexpr int kSpan = 8;

}  // namespace

void DepthPyramid::resize(int width, int height) {
  width_ = width;
  height_ = height;
  levels_.clear();
  std::size_t cells = 0;
  for (int w = width, h = height;; w = (w + 1) / 2, h = (h + 1) / 2) {
    levels_.push_back({cells, w, h});
    cells += static_cast<std::size_t>(w) * static_cast<std::size_t>(h);
    if (w <= kSpan && h <= kSpan) break;
  }
  cells_.resize(cells);
}

void DepthPyramid::build(std::span<const float> depths, int width, int height) {
  resize(width, height);
  std::copy(depths.begin(), depths.end(), cells_.begin());
  reduce();
}

void DepthPyramid::buildFromPicture(std::span<const float> picture, int pictureWidth, int pictureHeight,
                                    int width, int height) {
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
      for (int x = 0; x < to.width; ++x) {
        const int left = 2 * x, right = std::min(2 * x + 1, from.width - 1);
        out[x] = std::min(std::min(low[left], low[right]), std::min(high[left], high[right]));
      }
    }
  }
}

std::span<const float> DepthPyramid::depths() const {
  return {cells_.data(), static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_)};
}

bool DepthPyramid::covers(int x0, int y0, int x1, int y1, float limit) const {
  std::size_t level = 0;
  while (level + 1 < levels_.size() &&
         std::max((x1 >> level) - (x0 >> level), (y1 >> level) - (y0 >> level)) >= kSpan)
    ++level;
  const Level& l = levels_[level];
  for (int y = y0 >> level; y <= y1 >> level; ++y)
    for (int x = x0 >> level; x <= x1 >> level; ++x)
      // Said so that a depth that is not a number covers nothing.
      if (!(cells_[l.first + static_cast<std::size_t>(y) * static_cast<std::size_t>(l.width) +
                   static_cast<std::size_t>(x)] > limit))
        return false;
  return true;
}

bool DepthPyramid::isHidden(const Box& box, const EyePose& eye, const ViewShape& view) const {
  if (width_ <= 0 || height_ <= 0) return false;
  double lowX = 1e300, highX = -1e300, lowY = 1e300, highY = -1e300, nearest = 1e300;
  for (unsigned corner = 0; corner < 8; ++corner) {
    const Vec3 p = Vec3{corner & 1u ? box.maxX : box.minX, corner & 2u ? box.maxY : box.minY,
                        corner & 4u ? box.maxZ : box.minZ} -
                   eye.position;
    const Vec3 e = eye.axes * p;
    const double z = -e.z;
    // Said so that an eye that is not a number hides nothing.
    if (!(z > view.nearM * 1.01)) return false;
    nearest = std::min(nearest, z);
    lowX = std::min(lowX, e.x / z);
    highX = std::max(highX, e.x / z);
    lowY = std::min(lowY, e.y / z);
    highY = std::max(highY, e.y / z);
  }
  // A pixel and a bit around: rasterisers snap vertices, and floats relative to the eye are a little off.
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
