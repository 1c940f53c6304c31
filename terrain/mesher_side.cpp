#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "trimtab/terrain/mesher.h"

namespace trimtab::terrain {

void simplifySide(const HeightField& field, PolygonMesher::Point from, PolygonMesher::Point to,
                  double tolerance, std::vector<PolygonMesher::Point>& polyline) {
  using Point = PolygonMesher::Point;
  polyline.clear();
  polyline.push_back(from);
  if (from == to) return;
  const auto lesser = [](const Point& a, const Point& b) {
    return a.row != b.row ? a.row < b.row : a.column < b.column;
  };
  const bool turned = lesser(to, from);
  const Point start = turned ? to : from, end = turned ? from : to;
  const std::int64_t dx = std::int64_t{end.column} - start.column, dy = std::int64_t{end.row} - start.row;
  const std::int64_t steps = std::gcd(dx, dy);
  const auto at = [&](std::int64_t i) {
    return Point{static_cast<std::uint32_t>(start.column + dx / steps * i),
                 static_cast<std::uint32_t>(start.row + dy / steps * i)};
  };
  const float* const first = field.z + start.row * field.stride + start.column;
  const std::int64_t stride = dy / steps * static_cast<std::int64_t>(field.stride) + dx / steps;

  // Each part is split at its furthest post, the nearer half of the line first.
  std::vector<std::int64_t> kept;
  std::vector<std::pair<std::int64_t, std::int64_t>> parts{{0, steps}};
  while (!parts.empty()) {
    const auto [a, b] = parts.back();
    parts.pop_back();
    const double za = first[a * stride], slope = (first[b * stride] - za) / static_cast<double>(b - a);
    double worst = 0;
    std::int64_t split = a;
    for (std::int64_t i = a + 1; i < b; ++i) {
      const double off = std::fabs(first[i * stride] - (za + slope * static_cast<double>(i - a)));
      if (off > worst) {
        worst = off;
        split = i;
      }
    }
    const double scale = std::max({std::fabs(za), std::fabs(static_cast<double>(first[b * stride])), worst});
    if (worst > tolerance && worst > scale * 0x1p-38) {
      parts.push_back({split, b});
      parts.push_back({a, split});
    } else if (b != steps) {
      kept.push_back(b);
    }
  }
  if (turned) std::reverse(kept.begin(), kept.end());
  for (const std::int64_t i : kept) polyline.push_back(at(i));
  polyline.push_back(to);
}

}  // namespace trimtab::terrain
