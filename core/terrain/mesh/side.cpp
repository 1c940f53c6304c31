#include <algorithm>
#include <cmath>
#include <numeric>

#include "trimtab/terrain/mesh/mesher.h"
#include "trimtab/terrain/mesh/scan.h"

namespace trimtab::terrain {

namespace {

/// Finds a key for each of `steps` + 1 posts in a line, `stride` floats from one to the next. At any
/// tolerance not below `least`, the posts whose key is greater keep all others within it. A line is split at
/// its worst post, and so are its parts. The ends, and posts that no such tolerance needs, have the key 0.
void sideKeys(const float* z, std::ptrdiff_t stride, std::uint32_t steps, double least,
              std::vector<double>& keys) {
  struct Part {
    std::uint32_t a, b;
    double most;
  };
  keys.assign(steps + std::size_t{1}, 0.0);
  std::vector<Part> parts{{0, steps, HUGE_VAL}};
  while (!parts.empty()) {
    const auto [a, b, most] = parts.back();
    parts.pop_back();
    const double za = z[a * stride], zb = z[b * stride], slope = (zb - za) / (b - a);
    double worst = 0;
    std::uint32_t split = a;
    for (std::uint32_t i = a + 1; i < b; ++i) {
      const double off = std::fabs(z[i * stride] - (za + slope * (i - a)));
      if (off > worst) {
        worst = off;
        split = i;
      }
    }
    worst = roundedError(worst, std::max({std::fabs(za), std::fabs(zb), worst}));
    if (!(worst > least)) continue;
    keys[split] = std::min(worst, most);
    parts.push_back({a, split, keys[split]});
    parts.push_back({split, b, keys[split]});
  }
}

}  // namespace

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
  std::vector<double> keys;
  sideKeys(field.z + start.row * field.stride + start.column,
           static_cast<std::ptrdiff_t>(dy / steps * static_cast<std::int64_t>(field.stride) + dx / steps),
           static_cast<std::uint32_t>(steps), tolerance, keys);
  for (std::int64_t k = 1; k < steps; ++k) {
    const std::int64_t i = turned ? steps - k : k;
    if (keys[static_cast<std::size_t>(i)] > tolerance)
      polyline.push_back({static_cast<std::uint32_t>(start.column + dx / steps * i),
                          static_cast<std::uint32_t>(start.row + dy / steps * i)});
  }
  polyline.push_back(to);
}

}  // namespace trimtab::terrain
