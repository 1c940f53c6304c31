#pragma once

#include <span>
#include <vector>

#include "trimtab/culling/select.h"
#include "trimtab/frame/frame_request.h"
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

/// Says how distances follow from errors.
struct StaticLodRule {
  double distancePerError = 0;            ///< of staticLodDistancePerError
  double spread = 1, spreadFromM = 5000;  ///< LodParameters
  friend bool operator==(const StaticLodRule&, const StaticLodRule&) = default;
};

/// Returns the rule of what a request asks for.
StaticLodRule staticLodRuleOf(const FrameRequest& request);

/// Fills `cut` with exactly one node for each leaf, from the roots down: a node is drawn if the eye is at
/// least error * distancePerError from its box, spread as the rule says, else its children are tested; leaves
/// are drawn at any distance. An eye that is not a number gets the roots. `cut` has no normal cones: the
/// proof of back_facing.h needs a surface without holes and folds, and scenery promises neither.
void selectStatic(const StaticLodIndex& index, std::span<const float> error, const StaticLodRule& rule,
                  Vec3 eye, LevelCut& cut);
/// Fills `cut` with one level of all trees at any distance: nodes of `depth`, and leaves above it.
void selectStaticDepth(const StaticLodIndex& index, int depth, LevelCut& cut);
/// Computes the rest of a cut from its tiles. The two selectors call it.
void gather(const StaticLodIndex& index, LevelCut& cut);

/// Returns the nodes and triangles that are drawn, by depth in the trees.
StaticLodFrame staticLodFrame(const StaticLodIndex& index, const VisibleSet& visible);

}  // namespace trimtab
