#pragma once

#include <algorithm>
#include <array>

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

/// Haze of clear air, sRGB: the colour of the horizon and of thin fog.
inline constexpr std::array<float, 3> kHaze{0.74f, 0.80f, 0.86f};
/// After so many metres of clear air a third (1 / e) of a colour is left.
inline constexpr double kHazeDistanceM = 110e3;

}  // namespace trimtab::scene
