#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

#include "trimtab/units/linear.h"

extern "C" {
#include <quadmath.h>
}

/// The high-precision twin's arithmetic: 113 bits, so that its own error is 2^-60 of a double's.
namespace trimtab::stress {

__extension__ typedef __float128 Quad;

/// Half an ulp of 1 and less: the largest relative error of one rounding to double.
inline constexpr double kU = 0x1p-53;
/// The same for a float.
inline constexpr double kFloatU = 0x1p-24;

inline double toDouble(Quad q) {
  return static_cast<double>(q);
}
inline double distance(double measured, Quad exact) {
  // Equal infinities are no error; anything else that is not finite on one side only is.
  if (std::isinf(measured) && isinfq(exact) != 0 && (measured > 0) == (exact > 0)) return 0;
  return toDouble(fabsq(Quad{measured} - exact));
}
/// Relative to the exact value; 0 where both are 0.
inline double relative(double measured, Quad exact) {
  const double error = distance(measured, exact);
  if (error == 0) return 0;
  return exact == 0 ? std::numeric_limits<double>::infinity() : toDouble(Quad{error} / fabsq(exact));
}

inline Quad radians(Quad degrees) {
  static const Quad kPi = acosq(-1);
  return degrees * (kPi / 180);
}

/// Angles given in degrees are exact at quarter turns.
inline Quad sinDegrees(Quad degrees) {
  const Quad r = remainderq(degrees, 360);
  if (r == 0 || r == 180 || r == -180) return 0;
  if (r == 90) return 1;
  if (r == -90) return -1;
  return sinq(radians(r));
}
inline Quad cosDegrees(Quad degrees) {
  const Quad r = remainderq(degrees, 360);
  if (r == 90 || r == -90) return 0;
  if (r == 0) return 1;
  if (r == 180 || r == -180) return -1;
  return cosq(radians(r));
}

struct Quad3 {
  Quad x, y, z;

  friend Quad3 operator+(Quad3 a, Quad3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Quad3 operator-(Quad3 a, Quad3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Quad3 operator*(Quad3 a, Quad k) { return {a.x * k, a.y * k, a.z * k}; }
};
inline Quad3 quad(Vec3 v) {
  return {v.x, v.y, v.z};
}
inline Quad dot(Quad3 a, Quad3 b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Quad3 cross(Quad3 a, Quad3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Quad length(Quad3 a) {
  return sqrtq(dot(a, a));
}
inline double distance(Vec3 measured, Quad3 exact) {
  return toDouble(length(quad(measured) - exact));
}

/// `value` moved by so many representable numbers.
inline double stepped(double value, int ulps) {
  for (; ulps > 0; --ulps) value = std::nextafter(value, std::numeric_limits<double>::infinity());
  for (; ulps < 0; ++ulps) value = std::nextafter(value, -std::numeric_limits<double>::infinity());
  return value;
}

}  // namespace trimtab::stress
