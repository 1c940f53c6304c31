#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "trimtab/frame/normal_cone.h"
#include "trimtab/frame/terrain_index.h"

/// Nodes that the eye sees from behind only.
///
/// When they may be left out. Let the drawn surface be the graph of heights over the data's area, without
/// cracks, the eye above it, and let every straight line from the eye to a place on the surface stay over
/// that area (scene/data_extent tells). A line that ends at a place p from the side that the triangle at p
/// turns away comes from below the surface. It began above, so it went through the surface before p, from
/// above to below: through a front face, nearer than p. What is drawn there covers p, and with p every pixel
/// that p could own. The same proof serves GL's face culling, but for slivers that rounding turns over, of
/// which core/scene/gl/guard_band.h tells. The far cut takes nothing from that: a nearer face is within it
/// when p is. It fails for an eye below the surface or beyond the data, and where the near plane cuts the
/// front face away. So the drawers ask only where their occlusion tests may hide anything.
///
/// Rounding. Pictures are made from vertices rounded to parts of a pixel, so that a triangle seen edge-on may
/// turn over. kBackFacingMargin keeps nodes that have one so near its edge: what is left out is seen under
/// more than a degree from behind by each of its triangles, wherever in its box they lie.
namespace trimtab {

inline constexpr double kBackFacingMargin = 0.02;  ///< of a sine

/// Whether every triangle whose normal is in the cone, wherever in the box it lies, shows the eye its back.
/// False for anything that is not a number.
inline bool facesAway(const NormalCone& cone, const Box& b, Vec3 eye) {
  if (!cone.isKnown()) return false;
  const Vec3 low{b.minX, b.minY, b.minZ}, high{b.maxX, b.maxY, b.maxZ};
  const Vec3 axis = cone.axis(), away = eye - (low + high) * 0.5, half = (high - low) * 0.5;
  // Of eye - p for the box's points p: the furthest along the axis, and the longest.
  const double along =
      dot(away, axis) + half.x * std::abs(axis.x) + half.y * std::abs(axis.y) + half.z * std::abs(axis.z);
  if (!(along < 0)) return false;
  return along < -(length(away) + length(half)) * (cone.sine() + kBackFacingMargin);
}

/// How far a cone's axis leans from the frame's up, less the cone's half-angle, in kSteepnessSteps a radian,
/// rounded up: an eye that sees a node from behind is lower above it than this angle.
std::int16_t steepness(NormalCone cone);

inline constexpr double kSteepnessSteps = 1000;

/// False where no node in the box of that steepness or less can face away: what saves asking them.
bool mayFaceAway(std::int16_t steepness, const Box& box, Vec3 eye);

}  // namespace trimtab
