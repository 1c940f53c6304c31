#include "trimtab/terrain/ground_paint.h"

#include <algorithm>
#include <cmath>

namespace trimtab::terrain {

namespace {

/// How much of a texel's colour a line may at least have to be worth painting.
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

  /// Whether a cross about the point, its arms `reach` long, meets the triangle.
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

/// Smallest height of a triangle: the width of a line that it is a piece of.
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

GroundPaint::GroundPaint(std::span<const GroundTriangle> triangles, const PostGrid& posts,
                         const GroundShape& shape, std::uint32_t side)
    : triangles_(triangles), posts_(posts), shape_(shape), side_(side) {
  columns_ = (shape.levels[0].columns + side - 1) / side;
  rows_ = (shape.levels[0].rows + side - 1) / side;
  if (triangles.empty()) return;
  // Twice the same walk: how many a block has, then which.
  const auto forEachBlock = [&](const auto& visit) {
    for (std::uint32_t i = 0; i < triangles_.size(); ++i) {
      const auto c = cornersOf(triangles_[i], 1);
      const auto [west, east] = std::minmax({c[0].x, c[1].x, c[2].x});
      const auto [south, north] = std::minmax({c[0].y, c[1].y, c[2].y});
      // What is widened in the coarsest level of a block reaches half a texel of it further.
      const double more = triangles_[i].line == LineFeature::none ? 1 : 4;
      const auto block = [&](double x, std::uint32_t count) {
        return static_cast<std::int64_t>(std::clamp(std::floor(x / side_), -1.0, static_cast<double>(count)));
      };
      for (std::int64_t r = std::max<std::int64_t>(block(south - more, rows_), 0);
           r <= std::min<std::int64_t>(block(north + more, rows_), rows_ - 1); ++r)
        for (std::int64_t b = std::max<std::int64_t>(block(west - more, columns_), 0);
             b <= std::min<std::int64_t>(block(east + more, columns_), columns_ - 1); ++b)
          visit(static_cast<std::size_t>(r) * columns_ + static_cast<std::size_t>(b), i);
    }
  };
  first_.assign(std::size_t{columns_} * rows_ + 1, 0);
  forEachBlock([&](std::size_t block, std::uint32_t) { ++first_[block + 1]; });
  for (std::size_t b = 1; b < first_.size(); ++b) first_[b] += first_[b - 1];
  found_.resize(first_.back());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  forEachBlock([&](std::size_t block, std::uint32_t i) { found_[next[block]++] = i; });
}

std::span<const std::uint32_t> GroundPaint::inBlock(std::uint32_t column, std::uint32_t row) const {
  if (triangles_.empty()) return {};
  const std::size_t block = std::size_t{row} * columns_ + column;
  return std::span(found_).subspan(first_[block], first_[block + 1] - first_[block]);
}

void GroundPaint::paint(std::uint32_t blockColumn, std::uint32_t blockRow, const GroundWindow& window,
                        std::span<std::uint8_t> rgba) const {
  for (const std::uint32_t i : inBlock(blockColumn, blockRow)) {
    const GroundTriangle& triangle = triangles_[i];
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

void GroundPaint::paintLines(std::uint32_t blockColumn, std::uint32_t blockRow, std::uint32_t level,
                             std::uint32_t tileColumn, std::uint32_t tileRow,
                             std::span<const std::uint8_t> covered, GroundTile& tile) const {
  constexpr std::uint32_t kTile = GroundShape::kTile;
  const double scale = std::ldexp(1.0, -static_cast<int>(level));
  for (const std::uint32_t i : inBlock(blockColumn, blockRow)) {
    const GroundTriangle& triangle = triangles_[i];
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
