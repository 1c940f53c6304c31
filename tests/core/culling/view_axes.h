#pragma once

#include <cmath>
#include <numbers>

#include "trimtab/frame/eye_pose.h"

namespace trimtab::test {

/// An eye's right, up and backwards, by degrees: heading from +y towards +x, pitch upwards, roll with the
/// right side down.
inline Mat3 axesOf(double heading, double pitch = 0, double roll = 0) {
  constexpr double kRadians = std::numbers::pi / 180;
  const double h = heading * kRadians, p = pitch * kRadians, r = roll * kRadians;
  const Vec3 forward{std::sin(h) * std::cos(p), std::cos(h) * std::cos(p), std::sin(p)};
  const Vec3 level{std::cos(h), -std::sin(h), 0};
  const Vec3 above = cross(level, forward);
  return {{level * std::cos(r) - above * std::sin(r), above * std::cos(r) + level * std::sin(r), -forward}};
}

}  // namespace trimtab::test
