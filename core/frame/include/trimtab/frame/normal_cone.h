#pragma once

#include <cstdint>
#include <span>

#include "trimtab/units/geodesy.h"

namespace trimtab {

/// A cone that holds the normals of a node's triangles, in four bytes: two times twelve bits for the axis on
/// an octahedron, eight for the sine of the half-angle. It is rounded outwards.
struct NormalCone {
  std::uint32_t packed = kNone;

  /// Returns the cone that proves nothing, for unknown normals or normals that no half-space holds.
  static constexpr std::uint32_t kNone = 0xffffffffu;

  /// Returns a cone of unit normals: the narrowest around the middle of their bounds, which need not be the
  /// narrowest of all.
  static NormalCone of(std::span<const Vec3> normals);

  /// Returns a cone of at least this half-angle about a unit axis; unknown from a right angle on.
  static NormalCone about(Vec3 axis, double halfAngle);

  bool isKnown() const { return packed >> 24 != 0xff; }
  Vec3 axis() const;  ///< a unit vector; meaningless if the cone is unknown
  double sine() const { return static_cast<double>(packed >> 24) / 254; }  ///< of the half-angle

  friend bool operator==(const NormalCone&, const NormalCone&) = default;
};

}  // namespace trimtab
