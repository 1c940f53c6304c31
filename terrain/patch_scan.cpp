#include "trimtab/terrain/patch_scan.h"

namespace trimtab::terrain {

double longEdgeError(ScanVertex a, ScanVertex b, const PostStrip& strip, std::int32_t first,
                     std::int32_t last, double worst) {
  if (b.y < a.y) std::swap(a, b);
  const std::int32_t low = std::max(a.y, first), high = std::min(b.y, last);
  const std::int32_t sign = a.x < b.x ? 1 : -1;
  // Columns are crossed at whole numbers of `next` from a, rows between.
  const double dx = sign * (b.x - a.x), dy = b.y - a.y, slope = (b.z - a.z) / dy;
  const double perRow = dx / dy, perColumn = dy / dx;
  double e0 = 0;
  bool fresh = true;  // the surface has no steps: further on a cell begins where the one before ended
  for (std::int32_t y = low; y < high; ++y) {
    const float* const south = strip.row(y);
    const float* const north = south + strip.stride;
    const double start = (y - a.y) * perRow, end = (y + 1 - a.y) * perRow;  // columns from a
    auto column = static_cast<std::int32_t>(start + 1e-7);
    double u = std::max(0.0, start - column), v = 0;
    for (bool more = true; more; ++column, u = 0) {
      more = column + 1 < end - 1e-7;
      const double u1 = more ? 1.0 : end - column;
      const double v1 = more ? (column + 1) * perColumn - (y - a.y) : 1.0;
      // The cell, from the column that is nearer to a.
      const std::int32_t near = a.x + sign * column, far = near + sign;
      const double z0 = south[near], rise = south[far] - z0, climb = north[near] - z0,
                   twist = (static_cast<double>(north[far]) - south[far]) - climb;
      const auto off = [&](double s, double t) {
        return z0 + s * rise + t * (climb + s * twist) - (a.z + slope * ((y - a.y) + t));
      };
      if (fresh) e0 = off(u, v), fresh = false, worst = std::max(worst, std::fabs(e0));
      const double e1 = off(u1, v1);
      worst = bentError(e0, e1, twist * (u1 - u) * (v1 - v), worst);
      v = v1;
      e0 = e1;
    }
  }
  return worst;
}

}  // namespace trimtab::terrain
