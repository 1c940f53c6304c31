#include "trimtab/frame/normal_cone.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace trimtab {
namespace {

constexpr double kSteps = 2047;  // to each side of 0, so that the axes of the frame are exact

std::uint32_t stepsOf(double value) {
  return static_cast<std::uint32_t>(std::lround(std::clamp(value, -1.0, 1.0) * kSteps) + 2048);
}

double fromSteps(std::uint32_t steps) {
  return (static_cast<double>(steps & 0xfffu) - 2048) / kSteps;
}

/// Turns the lower half of the octahedron out over the upper one; and back.
void turnOut(double& x, double& y) {
  const double was = x;
  x = std::copysign(1 - std::abs(y), x);
  y = std::copysign(1 - std::abs(was), y);
}

std::uint32_t packedAxis(Vec3 axis) {
  const double sum = std::abs(axis.x) + std::abs(axis.y) + std::abs(axis.z);
  double x = axis.x / sum, y = axis.y / sum;
  if (axis.z < 0) turnOut(x, y);
  return stepsOf(x) | stepsOf(y) << 12;
}

}  // namespace

Vec3 NormalCone::axis() const {
  double x = fromSteps(packed), y = fromSteps(packed >> 12);
  const double z = 1 - std::abs(x) - std::abs(y);
  if (z < 0) turnOut(x, y);
  return normalized({x, y, z});
}

NormalCone NormalCone::about(Vec3 axis, double halfAngle) {
  NormalCone cone, tried{packedAxis(axis)};
  // Two thousandths: no axis is further from its place on the octahedron's lattice.
  const double angle = halfAngle + 2e-3;
  if (!(angle < std::numbers::pi / 2)) return cone;
  const double steps = std::ceil(std::sin(angle) * 254);
  if (!(steps <= 254)) return cone;
  tried.packed |= static_cast<std::uint32_t>(steps) << 24;
  return tried;
}

NormalCone NormalCone::of(std::span<const Vec3> normals) {
  NormalCone cone;
  if (normals.empty()) return cone;
  Vec3 low = normals.front(), high = low;
  for (const Vec3& n : normals) {
    low = {std::min(low.x, n.x), std::min(low.y, n.y), std::min(low.z, n.z)};
    high = {std::max(high.x, n.x), std::max(high.y, n.y), std::max(high.z, n.z)};
  }
  const Vec3 middle = low + high;
  if (!(dot(middle, middle) > 1e-12)) return cone;
  NormalCone tried{packedAxis(middle)};
  const Vec3 axis = tried.axis();
  double least = 1;
  for (const Vec3& n : normals) {
    const double cosine = dot(axis, n);
    // The test is written so that a cosine that is not a number leaves nothing known.
    if (!(cosine > 0)) return cone;
    least = std::min(least, cosine);
  }
  const double sine = std::sqrt(std::max(0.0, 1 - least * least)) + 1e-7;
  const double steps = std::ceil(sine * 254);
  if (steps > 254) return cone;
  tried.packed |= static_cast<std::uint32_t>(steps) << 24;
  return tried;
}

}  // namespace trimtab
