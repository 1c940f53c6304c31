#pragma once

#include <cstdint>

namespace trimtab {

/// What one image drew of the objects that stand on the ground, and why it did not draw the rest.
struct ObjectFrame {
  std::uint64_t drawn = 0;  ///< instances
  // Instances that were not drawn, by reason.
  std::uint64_t outsideFrustum = 0, occluded = 0, tooFar = 0, tooSmall = 0;
  std::uint64_t triangles = 0, vertices = 0;  ///< of those that were drawn

  std::uint64_t all() const { return drawn + outsideFrustum + occluded + tooFar + tooSmall; }
  friend bool operator==(const ObjectFrame&, const ObjectFrame&) = default;
};

}  // namespace trimtab
