#include "paint.h"

#include <algorithm>
#include <cmath>

namespace trimtab::terrain {

namespace {

/// A line of less than this part of a texel's colour is not worth painting.
constexpr double kFaintest = 0.3;

struct Edge {
  double x, y, dx, dy;
  /// Positive on the left.
  double side(double px, double py) const { return dx * (py - y) - dy * (px - x); }
};

/// A triangle among texels, widened along rows and columns by `reach`.
template <class Corner>
class Coverage {
 public:
  Coverage(std::array<Corner, 3> c, double reach) : reach_(reach) {
    const double area = (c[1].x - c[0].x) * (c[2].y - c[0].y) - (c[1].y - c[0].y) * (c[2].x - c[0].x);
    if (area < 0) std::swap(c[1], c[2]);
    for (std::size_t k = 0; k < 3; ++k) {
      const Corner &a = c[k], &b = c[(k + 1) % 3];
      edges_[k] = {a.x, a.y, b.x - a.x, b.y - a.y};
    }
    west_ = std::min({c[0].x, c[1].x, c[2].x}), east_ = std::max({c[0].x, c[1].x, c[2].x});
    south_ = std::min({c[0].y, c[1].y, c[2].y}), north_ = std::max({c[0].y, c[1].y, c[2].y});
  }

  template <class Paint>
  void forEach(double fromColumn, double fromRow, std::uint32_t columns, std::uint32_t rows,
               const Paint& paint) const {
    const auto first = [&](double x, double from) {
      return static_cast<std::int64_t>(std::max(std::ceil(x - reach_ - kSlack - 0.5 - from), 0.0));
    };
    const auto last = [&](double x, double from, std::uint32_t count) {
      return static_cast<std::int64_t>(std::min(std::floor(x + reach_ + kSlack - 0.5 - from), count - 1.0));
    };
    const std::int64_t c0 = first(west_, fromColumn), c1 = last(east_, fromColumn, columns);
    const std::int64_t r0 = first(south_, fromRow), r1 = last(north_, fromRow, rows);
    for (std::int64_t r = r0; r <= r1; ++r)
      for (std::int64_t c = c0; c <= c1; ++c)
        if (covers(fromColumn + static_cast<double>(c) + 0.5, fromRow + static_cast<double>(r) + 0.5))
          paint(static_cast<std::size_t>(r), static_cast<std::size_t>(c));
  }

 private:
  /// Part of a texel by which every triangle is wider, so that none falls between two.
  static constexpr double kSlack = 1e-4;

  /// Reports whether a cross about the point, its arms `reach` long, meets the triangle.
  bool covers(double x, double y) const {
    if (meets(x, y, 1, 0)) return true;
    return reach_ > 0 && meets(x, y, 0, 1);
  }
  /// Clips one arm pair by the three edges.
  bool meets(double x, double y, double alongX, double alongY) const {
    double low = -reach_ - kSlack, high = reach_ + kSlack;
    for (const Edge& e : edges_) {
      const double at = e.side(x, y), rate = e.dx * alongY - e.dy * alongX;
      if (rate > 0)
        low = std::max(low, -at / rate);
      else if (rate < 0)
        high = std::min(high, -at / rate);
      else if (at < -kSlack * (std::abs(e.dx) + std::abs(e.dy)))
        return false;
    }
    return low <= high;
  }

  std::array<Edge, 3> edges_{};
  double reach_, west_, east_, south_, north_;
};

/// Returns the smallest height of a triangle: the width of a line that it is a piece of.
template <class Corner>
double widthOf(const std::array<Corner, 3>& c) {
  double longest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Corner &a = c[k], &b = c[(k + 1) % 3];
    longest = std::max(longest, std::hypot(b.x - a.x, b.y - a.y));
  }
  const double area = (c[1].x - c[0].x) * (c[2].y - c[0].y) - (c[1].y - c[0].y) * (c[2].x - c[0].x);
  return longest > 0 ? std::abs(area) / longest : 0;
}

double reachOf(const GroundTriangle& triangle, double width) {
  return triangle.line == LineFeature::none ? 0 : std::max(0.0, (1 - width) / 2);
}

}  // namespace

std::array<GroundPaint::Corner, 3> GroundPaint::cornersOf(const GroundTriangle& triangle,
                                                          double scale) const {
  std::array<Corner, 3> corners{};
  for (std::size_t k = 0; k < 3; ++k)
    corners[k] = {shape_.texelOf((triangle.longitude[k] - posts_.west) / posts_.stepLongitude) * scale,
                  shape_.texelOf((triangle.latitude[k] - posts_.south) / posts_.stepLatitude) * scale};
  return corners;
}

Rectangle GroundPaint::degreesOf(std::uint32_t blockColumn, std::uint32_t blockRow) const {
  // A line that is widened in the coarsest level of a block reaches half a texel of it further.
  constexpr double kMore = 4;
  const auto post = [&](double texel) { return (texel - shape_.texelOf(0)) / shape_.texelsPerPost; };
  const double side = side_, column = side * blockColumn, row = side * blockRow;
  return {posts_.longitude(post(column - kMore)), posts_.latitude(post(row - kMore)),
          posts_.longitude(post(column + side + kMore)), posts_.latitude(post(row + side + kMore))};
}

void GroundPaint::paint(std::span<const GroundTriangle> triangles, const GroundWindow& window,
                        std::span<std::uint8_t> rgba) const {
  for (const GroundTriangle& triangle : triangles) {
    const auto corners = cornersOf(triangle, 1);
    const Coverage coverage(corners, reachOf(triangle, widthOf(corners)));
    coverage.forEach(window.column, window.row, window.columns, window.rows,
                     [&](std::size_t r, std::size_t c) {
                       std::uint8_t* texel = &rgba[(r * window.columns + c) * 4];
                       std::copy_n(triangle.colour.data(), 3, texel);
                       texel[3] = 255;
                     });
  }
}

void GroundPaint::paintLines(std::span<const GroundTriangle> triangles, std::uint32_t level,
                             std::uint32_t tileColumn, std::uint32_t tileRow,
                             std::span<const std::uint8_t> covered, GroundTile& tile) const {
  constexpr std::uint32_t kTile = GroundShape::kTile;
  const double scale = std::ldexp(1.0, -static_cast<int>(level));
  for (const GroundTriangle& triangle : triangles) {
    if (triangle.line == LineFeature::none) continue;
    const auto corners = cornersOf(triangle, scale);
    const double width = widthOf(corners), strength = std::min(2 * width, 1.0);
    if (strength < kFaintest) continue;
    const Coverage coverage(corners, reachOf(triangle, width));
    coverage.forEach(double{kTile} * tileColumn, double{kTile} * tileRow, kTile, kTile,
                     [&](std::size_t r, std::size_t c) {
                       if (covered[r * kTile + c] != 0) return;
                       GroundTexel& texel = tile[r * kTile + c];
                       // The line's share that halving left in the texel stays: no weaker than before.
                       const auto mixed = [&](std::uint8_t from, std::uint8_t to) {
                         return static_cast<std::uint8_t>(std::lround(from + (to - from) * strength));
                       };
                       texel.red = mixed(texel.red, triangle.colour[0]);
                       texel.green = mixed(texel.green, triangle.colour[1]);
                       texel.blue = mixed(texel.blue, triangle.colour[2]);
                     });
  }
}

}  // namespace trimtab::terrain
