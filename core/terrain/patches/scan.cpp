#include "scan.h"

#include <cassert>

namespace trimtab::terrain {

namespace {

/// Returns an upper bound on the distance of an edge, its lower end first: the largest distance where it
/// crosses rows and columns, plus the most that it can bend between. Whether it crosses a row or a column
/// next cannot be predicted, so rows and columns are visited separately.
double mostOff(const ScanVertex& a, const ScanVertex& b, const PostStrip& strip) {
  const std::int32_t sign = a.x < b.x ? 1 : -1, wide = sign * (b.x - a.x), high = b.y - a.y;
  const auto stride = static_cast<std::ptrdiff_t>(strip.stride);
  const float* const from = strip.row(a.y) + a.x;
  const double perRow = static_cast<double>(wide) / high, perColumn = static_cast<double>(high) / wide;
  double off = std::max(std::fabs(from[0] - a.z), std::fabs(from[high * stride + sign * wide] - b.z)),
         twist = 0;
  // South and north of an edge of cells, or near and far, and the same at the other edge of the cell beyond.
  const auto cross = [&](double p, double q, double nextP, double nextQ, double part, double z) {
    off = std::max(off, std::fabs(p + part * (q - p) - z));
    twist = std::max(twist, std::fabs((nextQ - q) - (nextP - p)));
  };
  for (std::int32_t column = 0; column < wide; ++column) {
    const double at = column * perColumn;
    const auto row = static_cast<std::int32_t>(at);
    const float* const south = from + row * stride + sign * column;
    const float* const north = south + stride;
    cross(south[0], north[0], south[sign], north[sign], at - row, a.z + (b.z - a.z) / wide * column);
  }
  for (std::int32_t row = 1; row < high; ++row) {
    const double at = row * perRow;
    const auto column = static_cast<std::int32_t>(at);
    const float* const south = from + row * stride + sign * column;
    const float* const north = south + stride;
    cross(south[0], south[sign], north[0], north[sign], at - column, a.z + (b.z - a.z) / high * row);
  }
  return off + twist * std::min(perRow, perColumn) / 4;
}

}  // namespace

double longEdgeError(ScanVertex a, ScanVertex b, const PostStrip& strip, std::int32_t first,
                     std::int32_t last, double worst) {
  assert(a.x != b.x && a.y != b.y);
  if (b.y < a.y) std::swap(a, b);
  // Once the worst edges have been measured, few need a closer look.
  if (a.y >= first && b.y <= last && mostOff(a, b, strip) <= worst) return worst;
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
