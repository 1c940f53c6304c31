#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "trimtab/culling/cut_rule.h"
#include "trimtab/culling/depth_pyramid.h"
#include "trimtab/culling/relief.h"
#include "trimtab/frame/eye_pose.h"
#include "trimtab/frame/object_index.h"
#include "trimtab/frame/visible_set.h"

/// Selects what a frame draws of the objects that stand on the ground: first by cell, then by instance.
namespace trimtab {

/// Holds what the objects of a terrain are selected by.
struct ObjectQuery {
  EyePose eye = {};  ///< in the index's frame
  ViewShape view = {};
  /// If false, nothing is left out that the image would not show anyway: because it is outside the view,
  /// hidden, or beyond `airM`.
  bool cull = true;
  CutRule rule;        ///< by which an instance's level follows from its error and its distance
  double leastPx = 0;  ///< an instance whose sphere looks smaller across, pixels, is not drawn
  /// An instance whose model's origin is farther from the eye is not drawn, metres.
  double farM = std::numeric_limits<double>::infinity();
  /// Nothing can be seen through more air than this, metres: an instance is left out if all of it is farther.
  double airM = std::numeric_limits<double>::infinity();
  /// A flag per cell, not 0 if everything in it is proven hidden; fewer flags are ignored.
  std::span<const std::uint8_t> hidden = {};
};

/// An instance as the GPU reads it.
struct DrawnObject {
  float x, y, z;  ///< its model's origin, metres from the eye, along the local frame
  float scale;
  std::array<std::int16_t, 4> turn;  ///< as ObjectInstance::turn
  std::uint32_t instance;            ///< its number in the index
  std::uint32_t cell;                ///< that it stands in
};
static_assert(sizeof(DrawnObject) == 32);

/// What a frame draws of the objects, and why it does not draw the rest.
struct VisibleObjects {
  std::vector<DrawnObject> drawn;           ///< sorted by level; within one, in the order of the index
  std::vector<std::uint32_t> firstOfLevel;  ///< into `drawn`, one per level of the index and one more

  /// One per cell: `drawn` if any instance of the cell may be drawn. What lies below a cell that is left out
  /// has the cell's reason.
  std::vector<CullReason> reason;
  // Instances by why they are not drawn, and what the drawn ones consist of.
  std::size_t outsideFrustum = 0, occluded = 0, tooFar = 0, tooSmall = 0;
  std::uint64_t triangles = 0, vertices = 0;

  // Working storage, kept from frame to frame.
  std::vector<DrawnObject> found;
  std::vector<std::uint32_t> levelOfFound;
};

/// Fills `visible`. An instance is drawn at the coarsest level whose error, seen from the nearest point of
/// the instance's sphere, the rule accepts; so an eye within the sphere sees the first level. Neither level
/// nor smallness depends on the direction of the view, so culling cannot change what a drawn instance looks
/// like. It keeps every instance that may own a pixel. An eye that is not a number gets nothing.
void selectObjects(const ObjectIndex& index, const ObjectQuery& query, VisibleObjects& visible);

/// Returns where the origin of an instance's model is, metres in the local frame of the index.
Vec3 placeOfObject(const ObjectIndex& index, std::uint32_t instance);
/// Returns the level by which an instance is drawn, its number in ObjectIndex::levels, if the eye is so far
/// from its model's origin, metres.
std::uint32_t levelOfObject(const ObjectIndex& index, const ObjectInstance& instance, double distanceM,
                            const CutRule& rule);

/// Sets a flag per cell, in the order of the index: 1 if its box is in the view and the map proves it hidden,
/// or if a cell that holds it is; else 0. The map must be of this eye and view.
void findHiddenCells(const ObjectIndex& index, const DepthPyramid& map, const EyePose& eye,
                     const ViewShape& view, std::vector<std::uint8_t>& hidden);

/// Returns the cells as a horizon tests them, one for each: they hide nothing, and their boxes may be hidden.
std::vector<Relief> reliefsOfCells(const ObjectIndex& index);

}  // namespace trimtab
