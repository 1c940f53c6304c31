#pragma once

#include <algorithm>

#include "trimtab/frame/terrain_index.h"

namespace trimtab {

/// Returns the squared distance from `p` to the nearest point of the box; 0 inside.
inline double distanceSquared(const Box& box, Vec3 p) {
  const double x = std::max({box.minX - p.x, 0.0, p.x - box.maxX});
  const double y = std::max({box.minY - p.y, 0.0, p.y - box.maxY});
  const double z = std::max({box.minZ - p.z, 0.0, p.z - box.maxZ});
  return x * x + y * y + z * z;
}

/// Returns true if the whole box lies outside the sphere of radius `farM` around the eye. Returns false for
/// anything that is not a number, and for an infinite radius.
inline bool isBeyond(const Box& box, Vec3 eye, double farM) {
  // Vertices are drawn from floats relative to the eye, whose error is below 1e-6 of their distance.
  const double reach = std::max(farM, 0.0) * (1 + 1e-6) + 1e-3;
  return distanceSquared(box, eye) > reach * reach;
}

}  // namespace trimtab
