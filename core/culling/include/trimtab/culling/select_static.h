#pragma once

#include <limits>
#include <span>
#include <vector>

#include "trimtab/culling/select.h"
#include "trimtab/frame/static_lod_frame.h"
#include "trimtab/frame/static_lod_index.h"

/// Which nodes of the trees of static levels of detail a frame draws (document E).
namespace trimtab {

/// A node's minimum viewer distance as a multiple of its error (metres a metre): nearer than that its
/// children stand for it. `pixelsPerRadian` is of the view's finer axis; a larger `lodScale` lets coarser
/// nodes nearer.
double staticLodDistancePerError(const StaticLodParameters& parameters, double lodScale,
                                 double pixelsPerRadian);

/// Returns the error that the distances follow, in metres, one per node: the vertical error of the measure or
/// the horizontal error of material borders, whichever is larger; the vertical error alone for
/// `as_published`.
std::vector<float> staticLodError(const StaticLodIndex& index, ErrorMeasure measure);

/// The cut through the trees: every leaf is covered by exactly one node. Independent of view direction and of
/// culling, so that culling cannot change what a drawn node looks like.
struct StaticCut {
  std::vector<std::uint32_t> nodes;  ///< order is a function of the trees only
  std::vector<std::uint32_t> stack;  ///< kept so that a frame allocates nothing
};

/// Top-down: a node is drawn when the viewer is at least error x `distancePerError` from its box, else its
/// children are asked; leaves are drawn at any distance. An eye that is not a number gets the roots.
void selectStatic(const StaticLodIndex& index, std::span<const float> error, double distancePerError,
                  Vec3 eye, StaticCut& cut);
/// One level of all trees whatever the distance: nodes of `depth`, and leaves above it.
void selectStaticDepth(const StaticLodIndex& index, int depth, StaticCut& cut);

/// As selectVisible, weather's far distance included: `visible.tiles` holds nodes of the trees and
/// `visible.reason` is one a node of `cut`. `vertices` has the number of vertices of each node. No node is
/// left out for showing its back: the proof of back_facing.h needs a surface without holes and folds, and
/// scenery promises neither.
void selectStaticVisible(const StaticLodIndex& index, std::span<const std::uint32_t> vertices,
                         const StaticCut& cut, const EyePose& eye, const ViewShape& view, bool test,
                         VisibleSet& visible, double farM = std::numeric_limits<double>::infinity());
/// As removeOccluded: one flag a node of `visible.tiles`, in order; 1 is proven hidden.
void removeStaticOccluded(const StaticLodIndex& index, std::span<const std::uint32_t> vertices,
                          std::span<const std::uint8_t> flags, VisibleSet& visible);

/// What is drawn, by depth.
StaticLodFrame staticLodFrame(const StaticLodIndex& index, const VisibleSet& visible);

}  // namespace trimtab
