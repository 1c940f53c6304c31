#pragma once

#include <algorithm>

#include "trimtab/units/linear.h"

namespace trimtab::scene {

/// Direction towards the sun, which never moves; not of unit length.
inline constexpr Vec3 kTowardsSun{0.55, -0.60, 0.58};

inline constexpr double kSkyLight = 0.30, kUpwardLight = 0.12, kSunLight = 1.05;
/// Returns the light on ground of a normal, from the sky and from the sun. light.glsl computes the same.
inline double lightOn(const Vec3& normal) {
  return kSkyLight + kUpwardLight * normal.z +
         kSunLight * std::max(dot(normal, normalized(kTowardsSun)), 0.0);
}
inline constexpr double kMostLight = 1.5;

}  // namespace trimtab::scene
