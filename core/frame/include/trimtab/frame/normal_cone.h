#pragma once

#include <cstdint>
#include <span>

#include "trimtab/units/geodesy.h"

namespace trimtab {

/// Where the front faces of a node's triangles look, in four bytes: an axis and the half-angle about it that
/// holds the normal of each, rounded outwards. Twelve bits each for the axis on an octahedron, eight for the
/// sine of the half-angle.
struct NormalCone {
  std::uint32_t packed = kNone;

  /// Nothing is known, or no half-space holds all normals: it never proves anything.
  static constexpr std::uint32_t kNone = 0xffffffffu;

  /// Of unit normals; narrowest about the middle of their bounds, not the narrowest there is.
  static NormalCone of(std::span<const Vec3> normals);

  /// Of that half-angle and more about a unit axis; nothing known from a right angle on.
  static NormalCone about(Vec3 axis, double halfAngle);

  bool isKnown() const { return packed >> 24 != 0xff; }
  Vec3 axis() const;  ///< unit; anything where nothing is known
  double sine() const { return static_cast<double>(packed >> 24) / 254; }  ///< of the half-angle

  friend bool operator==(const NormalCone&, const NormalCone&) = default;
};

}  // namespace trimtab
