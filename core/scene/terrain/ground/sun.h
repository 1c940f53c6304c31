#pragma once

#include <algorithm>

#include "trimtab/units/linear.h"

namespace trimtab::scene {

/// Towards the sun, which stands still; not of unit length.
inline constexpr Vec3 kTowardsSun{0.55, -0.60, 0.58};

/// Light on ground of a normal: from the sky, and from the sun. kTerrainVertex does the same.
inline double lightOn(const Vec3& normal) {
  return 0.30 + 0.12 * normal.z + 1.05 * std::max(dot(normal, normalized(kTowardsSun)), 0.0);
}
inline constexpr double kMostLight = 1.5;

}  // namespace trimtab::scene
