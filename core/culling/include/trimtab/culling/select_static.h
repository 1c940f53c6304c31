#pragma once

#include <limits>
#include <span>
#include <vector>

#include "trimtab/culling/select.h"
#include "trimtab/frame/static_lod_frame.h"
#include "trimtab/frame/static_lod_index.h"

/// Selects the nodes of the static LOD trees that a frame draws (document E).
namespace trimtab {

/// Returns a node's minimum viewer distance as a multiple of its error (metres per metre). Nearer than that
/// its children are drawn. `pixelsPerRadian` is pixelsPerRadian(view); a larger `lodScale` allows coarser
/// nodes nearer.
double staticLodDistancePerError(const StaticLodParameters& parameters, double lodScale,
                                 double pixelsPerRadian);

/// Returns the error that the distances follow, in metres, one per node: the vertical error of the measure or
/// the horizontal error of material borders, whichever is larger; the vertical error alone for
/// `as_published`.
std::vector<float> staticLodError(const StaticLodIndex& index, ErrorMeasure measure);

/// A cut through the trees, in which exactly one node covers each leaf. It does not depend on the view
/// direction or on culling, so culling cannot change what a drawn node looks like.
struct StaticCut {
  std::vector<std::uint32_t> nodes;  ///< the order depends on the trees only
  std::vector<std::uint32_t> stack;  ///< working storage, kept so that a frame allocates nothing
};

/// Fills `cut` from the roots down: a node is drawn if the eye is at least error * distancePerError from its
/// box, else its children are tested; leaves are drawn at any distance. An eye that is not a number gets the
/// roots.
void selectStatic(const StaticLodIndex& index, std::span<const float> error, double distancePerError,
                  Vec3 eye, StaticCut& cut);
/// Fills `cut` with one level of all trees at any distance: nodes of `depth`, and leaves above it.
void selectStaticDepth(const StaticLodIndex& index, int depth, StaticCut& cut);

/// Does what selectVisible does, for the nodes of a cut through the trees. `vertices` holds the number of
/// vertices of each node. No node is left out because it shows its back: the proof of back_facing.h needs a
/// surface without holes and folds, and scenery promises neither.
void selectStaticVisible(const StaticLodIndex& index, std::span<const std::uint32_t> vertices,
                         const StaticCut& cut, const EyePose& eye, const ViewShape& view, bool test,
                         VisibleSet& visible, double farM = std::numeric_limits<double>::infinity());
/// Does what removeOccluded does: one flag per node of `visible.tiles`, in order; 1 says that it is proven
/// hidden.
void removeStaticOccluded(const StaticLodIndex& index, std::span<const std::uint32_t> vertices,
                          std::span<const std::uint8_t> flags, VisibleSet& visible);

/// Returns the nodes and triangles that are drawn, by depth in the trees.
StaticLodFrame staticLodFrame(const StaticLodIndex& index, const VisibleSet& visible);

}  // namespace trimtab
