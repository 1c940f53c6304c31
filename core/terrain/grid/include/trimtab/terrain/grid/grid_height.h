#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "trimtab/terrain/grid/post_grid.h"

namespace trimtab::terrain {

/// Returns the bilinear height at a place in degrees. If some of the four posts are voids, the others are
/// used; returns NaN if all are voids or the place is outside the grid. `at(row, column)` returns a post's
/// height, NaN at voids.
template <class At>
double heightOf(const PostGrid& posts, double longitude, double latitude, const At& at) {
  // Places on the grid's own border, computed another way, may be a rounding beyond it.
  constexpr double kSlack = 1e-6;
  const double turn = std::remainder(longitude - posts.west, 360.0);
  const double c = (turn < -kSlack ? turn + 360 : turn) / posts.stepLongitude,
               r = (latitude - posts.south) / posts.stepLatitude;
  if (!(c >= -kSlack && r >= -kSlack && c <= posts.columns - 1 + kSlack && r <= posts.rows - 1 + kSlack))
    return std::numeric_limits<double>::quiet_NaN();
  const double lastC = posts.columns - 1, lastR = posts.rows - 1;
  const double fc = std::clamp(c, 0.0, lastC), fr = std::clamp(r, 0.0, lastR);
  const auto c0 = static_cast<std::uint32_t>(fc), r0 = static_cast<std::uint32_t>(fr);
  const std::uint32_t c1 = std::min(c0 + 1, posts.columns - 1), r1 = std::min(r0 + 1, posts.rows - 1);
  const double x = fc - c0, y = fr - r0;
  double sum = 0, weight = 0;
  const auto add = [&](std::uint32_t row, std::uint32_t column, double w) {
    if (w <= 0) return;
    const float z = at(row, column);
    if (std::isnan(z)) return;
    sum += w * static_cast<double>(z);
    weight += w;
  };
  add(r0, c0, (1 - x) * (1 - y));
  add(r0, c1, x * (1 - y));
  add(r1, c0, (1 - x) * y);
  add(r1, c1, x * y);
  return weight > 0 ? sum / weight : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace trimtab::terrain
