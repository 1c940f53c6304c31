#include "trimtab/measure/geometric_error.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <vector>

namespace trimtab {
namespace {

/// Stands for infinitely far: a line to it is the line that never ends to the seventh digit, and its square
/// is still a float.
constexpr float kFar = 1e12f;
/// Beyond this ratio of depths, floats cannot hold a place on a line that is measured from its far end.
constexpr float kSteep = 16;
constexpr float kMuch = 1e30f;

/// Holds what both directions share: directions of pixels (tangents), and what a pixel spans at depth 1.
struct Lattice {
  int width, height, window;
  float pixel;  ///< tangent of the finer axis' pixel: the unit of the result
  float slant;  ///< a line r pixels aside in the image is no nearer than r times this
  float stepX, stepY;
  std::vector<float> across, up;

  Lattice(const ViewShape& v, int windowPx)
      : width(v.widthPx),
        height(v.heightPx),
        window(windowPx),
        across(static_cast<std::size_t>(v.widthPx)),
        up(static_cast<std::size_t>(v.heightPx)) {
    const double dx = (v.right - v.left) / v.widthPx, dy = (v.top - v.bottom) / v.heightPx;
    stepX = static_cast<float>(dx);
    stepY = static_cast<float>(dy);
    pixel = std::min(stepX, stepY);
    double widest = 0;
    for (std::size_t x = 0; x < across.size(); ++x)
      across[x] = static_cast<float>(v.left + dx * (static_cast<double>(x) + 0.5));
    for (std::size_t y = 0; y < up.size(); ++y)
      up[y] = static_cast<float>(v.bottom + dy * (static_cast<double>(y) + 0.5));
    for (const double a : {v.left, v.right})
      for (const double b : {v.bottom, v.top}) widest = std::max(widest, a * a + b * b);
    slant = static_cast<float>(1 / std::sqrt(1 + widest));
  }
  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
  /// Returns the distance to the image's edge, in pixels of the result.
  float toEdge(int x, int y) const {
    const auto least = [](int i, int count) { return static_cast<float>(std::min(i, count - 1 - i)) + 0.5f; };
    return std::min(least(x, width) * stepX, least(y, height) * stepY) / pixel;
  }
};

/// Depths along the view's axis from distances.
std::vector<float> depthsOf(std::span<const float> distances, const Lattice& lattice) {
  std::vector<float> depths(distances.size());
  for (int y = 0; y < lattice.height; ++y) {
    const float b = lattice.up[static_cast<std::size_t>(y)];
    const float* in = distances.data() + lattice.at(0, y);
    float* out = depths.data() + lattice.at(0, y);
    const float* a = lattice.across.data();
    for (int x = 0; x < lattice.width; ++x) {
      // The test is written so that a depth that is not a number counts as far.
      const bool drawn = in[x] > 0 && in[x] < kFar;
      const float depth = in[x] / std::sqrt(1 + a[x] * a[x] + b * b);
      out[x] = drawn ? depth : kFar;
    }
  }
  return depths;
}

/// Returns the square of the distance from (a, b, 1) to the line from (a, b, 1) r0 to (a + step, b, 1) r1, by
/// `along` = a; of a line in the column likewise with b.
inline float toOwnLine(float g, float r0, float r1, float along, float step, float length2) {
  const float k = r1 - r0, side = step * r1;
  const float dd = k * k * length2 + 2 * along * side * k + side * side;
  float s = -g * (k * length2 + along * side) / dd;
  s = s < 0 ? 0 : s;
  s = s > 1 ? 1 : s;
  const float h = g + s * k, m = s * side;
  return h * h * length2 + 2 * along * h * m + m * m;
}

/// Computes, for pixels 1 to width - 2 of a row that is not the first or last, the square of the distance to
/// the four lines that end in the same pixel of the other image. Nothing branches, so that it is vector
/// instructions.
void toOwnLines(const float* own, const float* other, int width, const float* across, float up, float stepX,
                float stepY, float* square) {
  for (int x = 1; x + 1 < width; ++x) {
    const float inverse = 1 / own[x], a = across[x];
    const float length2 = 1 + a * a + up * up;
    const float r0 = other[x] * inverse, g = r0 - 1;
    const float left = toOwnLine(g, r0, other[x - 1] * inverse, a, -stepX, length2),
                right = toOwnLine(g, r0, other[x + 1] * inverse, a, stepX, length2),
                down = toOwnLine(g, r0, other[x - width] * inverse, up, -stepY, length2),
                above = toOwnLine(g, r0, other[x + width] * inverse, up, stepY, length2);
    const float horizontal = left < right ? left : right, vertical = down < above ? down : above;
    const float least = horizontal < vertical ? horizontal : vertical;
    square[x] = r0 > kSteep ? kMuch : least;
  }
}

/// The search around a pixel, ring by ring, until no line further out can be nearer.
class Search {
 public:
  Search(const Lattice& lattice, const float* other, int x, int y)
      : lattice_(lattice), other_(other), x_(x), y_(y) {}

  float ground(float depth) {
    inverse_ = 1 / depth;
    a_ = lattice_.across[static_cast<std::size_t>(x_)];
    b_ = lattice_.up[static_cast<std::size_t>(y_)];
    const float most =
        std::min(static_cast<float>(lattice_.window), lattice_.toEdge(x_, y_)) * lattice_.pixel;
    best_ = most;
    best2_ = most * most;
    const float reach = lattice_.slant * lattice_.pixel;
    for (int r = 0; r < lattice_.window && static_cast<float>(r) * reach < best_; ++r) {
      // The ring's own lines, then those out to the next ring.
      for (int i = -r; i < r; ++i) {
        line(i, -r, i + 1, -r);
        line(i, r, i + 1, r);
        line(-r, i, -r, i + 1);
        line(r, i, r, i + 1);
      }
      for (int i = -r; i <= r; ++i) {
        line(i, -r, i, -r - 1);
        line(i, r, i, r + 1);
        line(-r, i, -r - 1, i);
        line(r, i, r + 1, i);
      }
    }
    return best_ / lattice_.pixel;
  }

  float sky() const {
    float best = std::min(static_cast<float>(lattice_.window), lattice_.toEdge(x_, y_));
    const float scaleX = lattice_.stepX / lattice_.pixel, scaleY = lattice_.stepY / lattice_.pixel;
    const auto look = [&](int dx, int dy) {
      if (!inside(dx, dy) || other_[lattice_.at(x_ + dx, y_ + dy)] < kFar) return;
      best = std::min(best, std::hypot(static_cast<float>(dx) * scaleX, static_cast<float>(dy) * scaleY));
    };
    look(0, 0);
    for (int r = 1; r <= lattice_.window && static_cast<float>(r) < best; ++r)
      for (int i = -r; i <= r; ++i) {
        look(i, -r);
        look(i, r);
        look(-r, i);
        look(r, i);
      }
    return best;
  }

 private:
  bool inside(int dx, int dy) const {
    return x_ + dx >= 0 && x_ + dx < lattice_.width && y_ + dy >= 0 && y_ + dy < lattice_.height;
  }

  void line(int x0, int y0, int x1, int y1) {
    if (!inside(x0, y0) || !inside(x1, y1)) return;
    float r0 = other_[lattice_.at(x_ + x0, y_ + y0)] * inverse_,
          r1 = other_[lattice_.at(x_ + x1, y_ + y1)] * inverse_;
    // The line begins at its nearer end, which floats can distinguish from the pixel's point.
    if (r1 < r0) {
      std::swap(r0, r1);
      std::swap(x0, x1);
      std::swap(y0, y1);
    }
    if (r0 - 1 >= best_ || 1 - r1 >= best_) return;
    const float a0 = a_ + static_cast<float>(x0) * lattice_.stepX,
                b0 = b_ + static_cast<float>(y0) * lattice_.stepY,
                a1 = a_ + static_cast<float>(x1) * lattice_.stepX,
                b1 = b_ + static_cast<float>(y1) * lattice_.stepY;
    const float ux = a0 * r0 - a_, uy = b0 * r0 - b_, uz = r0 - 1;
    const float dx = a1 * r1 - a0 * r0, dy = b1 * r1 - b0 * r0, dz = r1 - r0;
    const float s = std::clamp(-(ux * dx + uy * dy + uz * dz) / (dx * dx + dy * dy + dz * dz), 0.0f, 1.0f);
    const float vx = ux + s * dx, vy = uy + s * dy, vz = uz + s * dz;
    const float square = vx * vx + vy * vy + vz * vz;
    if (!(square < best2_)) return;
    best2_ = square;
    best_ = std::sqrt(square);
  }

  const Lattice& lattice_;
  const float* other_;
  int x_, y_;
  float inverse_ = 1, a_ = 0, b_ = 0, best_ = 0, best2_ = 0;
};

/// Measures one direction: how far what `own` shows lies from what `other` shows.
GeometricError oneWay(const std::vector<float>& own, const std::vector<float>& other,
                      const Lattice& lattice) {
  const int w = lattice.width, h = lattice.height;
  std::vector<float> square(static_cast<std::size_t>(w));
  // No other line improves on a distance to the own lines below this.
  const float near2 = lattice.slant * lattice.pixel * lattice.slant * lattice.pixel;
  const float mostPx = static_cast<float>(lattice.window);
  double sum = 0;
  float most = 0;
  for (int y = 0; y < h; ++y) {
    const float *a = own.data() + lattice.at(0, y), *b = other.data() + lattice.at(0, y);
    if (std::memcmp(a, b, static_cast<std::size_t>(w) * sizeof(float)) == 0) continue;
    const bool edge = y == 0 || y == h - 1;
    if (!edge)
      toOwnLines(a, b, w, lattice.across.data(), lattice.up[static_cast<std::size_t>(y)], lattice.stepX,
                 lattice.stepY, square.data());
    double ofRow = 0;
    for (int x = 0; x < w; ++x) {
      if (a[x] == b[x]) continue;
      const float near = edge || x == 0 || x == w - 1 ? kMuch : square[static_cast<std::size_t>(x)];
      const float error = a[x] >= kFar    ? Search(lattice, other.data(), x, y).sky()
                          : near <= near2 ? std::min(std::sqrt(near) / lattice.pixel, mostPx)
                                          : Search(lattice, other.data(), x, y).ground(a[x]);
      ofRow += double{error};
      most = std::max(most, error);
    }
    sum += ofRow;
  }
  return {double{most}, sum / (static_cast<double>(w) * h)};
}

}  // namespace

GeometricError geometricError(std::span<const float> reference, std::span<const float> ours,
                              const ViewShape& view, int windowPx) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  if (view.widthPx <= 0 || view.heightPx <= 0 || !(view.left < view.right) || !(view.bottom < view.top) ||
      windowPx < 1)
    return {kNone, kNone};
  const std::size_t pixels = static_cast<std::size_t>(view.widthPx) * static_cast<std::size_t>(view.heightPx);
  if (reference.size() != pixels || ours.size() != pixels) return {kNone, kNone};
  if (std::memcmp(reference.data(), ours.data(), pixels * sizeof(float)) == 0) return {};
  const Lattice lattice(view, windowPx);
  const std::vector<float> a = depthsOf(reference, lattice), b = depthsOf(ours, lattice);
  const GeometricError there = oneWay(a, b, lattice), back = oneWay(b, a, lattice);
  return {std::max(there.maxPx, back.maxPx), std::max(there.meanPx, back.meanPx)};
}

std::vector<float> distancesUpTo(double farM, std::vector<float> distances) {
  for (float& distance : distances)
    if (double{distance} > farM) distance = std::numeric_limits<float>::infinity();
  return distances;
}

}  // namespace trimtab
