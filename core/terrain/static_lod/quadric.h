#pragma once

#include <algorithm>
#include <optional>

#include "trimtab/units/linear.h"

namespace trimtab::terrain {

/// Weighted sum of squared distances to planes (Garland and Heckbert): x'Ax + 2b'x + c, in m^2 times the
/// weights' unit.
struct Quadric {
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
  double bx = 0, by = 0, bz = 0, c = 0;

  /// Returns the quadric of the plane through `point` with a unit normal.
  static Quadric plane(Vec3 normal, Vec3 point, double weight) {
    const double d = -dot(normal, point);
    const Vec3 w = weight * normal;
    return {w.x * normal.x, w.x * normal.y, w.x * normal.z, w.y * normal.y, w.y * normal.z,
            w.z * normal.z, w.x * d,        w.y * d,        w.z * d,        weight * d * d};
  }

  Quadric& operator+=(const Quadric& o) {
    xx += o.xx, xy += o.xy, xz += o.xz, yy += o.yy, yz += o.yz, zz += o.zz;
    bx += o.bx, by += o.by, bz += o.bz, c += o.c;
    return *this;
  }
  Quadric& operator-=(const Quadric& o) {
    xx -= o.xx, xy -= o.xy, xz -= o.xz, yy -= o.yy, yz -= o.yz, zz -= o.zz;
    bx -= o.bx, by -= o.by, bz -= o.bz, c -= o.c;
    return *this;
  }
  friend Quadric operator+(Quadric a, const Quadric& b) { return a += b; }
  friend Quadric operator-(Quadric a, const Quadric& b) { return a -= b; }

  Vec3 times(Vec3 v) const {
    return {xx * v.x + xy * v.y + xz * v.z, xy * v.x + yy * v.y + yz * v.z, xz * v.x + yz * v.y + zz * v.z};
  }
  /// Returns the sum at a place, never below zero.
  double at(Vec3 v) const { return std::max(0.0, dot(v, times(v)) + 2 * dot({bx, by, bz}, v) + c); }
  /// Returns the sum of the planes' weights.
  double weight() const { return xx + yy + zz; }

  /// Returns where the sum is least; unset if that is a line or a plane. `near` is any place close by, which
  /// keeps digits.
  std::optional<Vec3> least(Vec3 near) const {
    const Vec3 slope = times(near) + Vec3{bx, by, bz};
    const double cxx = yy * zz - yz * yz, cxy = xz * yz - xy * zz, cxz = xy * yz - xz * yy;
    const double determinant = xx * cxx + xy * cxy + xz * cxz;
    const double scale = weight();
    // Landscape is nearly flat: its least eigenvalues are small, not its sums.
    if (!(determinant > 1e-9 * scale * scale * scale)) return std::nullopt;
    const double cyy = xx * zz - xz * xz, cyz = xy * xz - xx * yz, czz = xx * yy - xy * xy;
    const double k = -1 / determinant;
    return near + Vec3{k * (cxx * slope.x + cxy * slope.y + cxz * slope.z),
                       k * (cxy * slope.x + cyy * slope.y + cyz * slope.z),
                       k * (cxz * slope.x + cyz * slope.y + czz * slope.z)};
  }
  /// Returns where the sum is least between two places.
  Vec3 leastBetween(Vec3 from, Vec3 to) const {
    const Vec3 along = to - from;
    const double curve = dot(along, times(along));
    const double slope = dot(along, times(from) + Vec3{bx, by, bz});
    const double t = curve > 0 ? std::clamp(-slope / curve, 0.0, 1.0) : 0.5;
    return from + t * along;
  }
};

}  // namespace trimtab::terrain
