#pragma once

#include <cmath>
#include <cstdint>

#include "trimtab/frame/normal_cone.h"
#include "trimtab/frame/terrain_index.h"

/// Nodes of which the eye sees only the back.
///
/// Leaving them out changes no pixel as long as the drawn surface is a graph of heights without cracks, the
/// eye is above it, and every straight line from the eye to the surface stays over the data's area
/// (scene::DataExtent checks that). A line that reaches a triangle from behind comes from below the surface,
/// so it passed through a nearer front face before, which covers it. The proof fails for an eye below the
/// surface or beyond the data, and where the near plane cuts the front face away: ask for it only where
/// occlusion tests may hide anything. resources/docs/occlusion.md has the derivation;
/// core/scene/gl/guard_band.h covers slivers that rounding turns over.
namespace trimtab {

/// Sine of the angle by which every triangle of a node must turn away before the node counts as facing away.
/// It is more than a degree, because vertices are rounded to parts of a pixel, which may turn a triangle that
/// is seen edge-on.
inline constexpr double kBackFacingMargin = 0.02;

/// Returns true if every triangle whose normal is in the cone shows the eye its back, wherever in the box it
/// lies. Returns false if any argument is not a number.
inline bool facesAway(const NormalCone& cone, const Box& b, Vec3 eye) {
  if (!cone.isKnown()) return false;
  const Vec3 low{b.minX, b.minY, b.minZ}, high{b.maxX, b.maxY, b.maxZ};
  const Vec3 axis = cone.axis(), away = eye - (low + high) * 0.5, half = (high - low) * 0.5;
  // For the vectors eye - p to all points p of the box, `along` is the largest component along the axis, and
  // `longest` bounds their length.
  const double along =
      dot(away, axis) + half.x * std::abs(axis.x) + half.y * std::abs(axis.y) + half.z * std::abs(axis.z);
  if (!(along < 0)) return false;
  return along < -(length(away) + length(half)) * (cone.sine() + kBackFacingMargin);
}

/// Returns how far a cone's axis leans from the frame's up direction, less the cone's half-angle, in
/// 1/kSteepnessSteps radians, rounded up. An eye that sees a node from behind is at a lower elevation above
/// it.
std::int16_t steepness(NormalCone cone);

inline constexpr double kSteepnessSteps = 1000;

/// Returns false if no node in the box with this steepness or less can face away. Then the nodes need no test
/// of their own.
bool mayFaceAway(std::int16_t steepness, const Box& box, Vec3 eye);

}  // namespace trimtab
