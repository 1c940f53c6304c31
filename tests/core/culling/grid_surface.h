#pragma once

#include <algorithm>
#include <cmath>

#include "trimtab/frame/frame.h"

/// Surfaces over square grids of posts, asked point by point.
namespace trimtab::test {

/// At shares a eastwards and b northwards of a cell with these corners, in two triangles; `risesEast`: its
/// diagonal runs from south-west to north-east.
inline double heightInCell(double a, double b, bool risesEast, double sw, double se, double nw, double ne) {
  if (risesEast) return a > b ? sw + a * (se - sw) + b * (ne - se) : sw + b * (nw - sw) + a * (ne - nw);
  return a + b < 1 ? sw + a * (se - sw) + b * (nw - sw) : ne + (1 - a) * (nw - ne) + (1 - b) * (se - ne);
}

/// Whether the ground is over the segment from `eye` to `p` anywhere before its end: exact where the height
/// over a straight way is linear from one line of the grid, or of its diagonals, to the next.
template <class HeightAt>
bool isCovered(Vec3 eye, Vec3 p, double stepM, const HeightAt& heightAt) {
  const Vec3 d = p - eye;
  const auto over = [&](double s) {
    return s > 0 && s < 1 - 1e-9 && heightAt(eye.x + s * d.x, eye.y + s * d.y) > eye.z + s * d.z;
  };
  const auto along = [&](double from, double by) {
    if (by == 0) return false;
    const double a = from / stepM, b = (from + by) / stepM;
    for (double k = std::ceil(std::min(a, b)); k <= std::max(a, b); ++k)
      if (over((k * stepM - from) / by)) return true;
    return false;
  };
  return along(eye.x, d.x) || along(eye.y, d.y) || along(eye.x + eye.y, d.x + d.y) ||
         along(eye.x - eye.y, d.x - d.y);
}

}  // namespace trimtab::test
