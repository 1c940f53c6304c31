#include "trimtab/culling/select_static.h"

#include <algorithm>

#include "gather_cut.h"
#include "trimtab/culling/box_distance.h"
#include "trimtab/culling/tree_walk.h"

namespace trimtab {
namespace {

/// Walks the trees from the roots; `descend` says whether a node's children are drawn instead of it.
template <class Descend>
void walk(const StaticLodIndex& index, LevelCut& cut, const Descend& descend) {
  cut.tiles.clear();
  cut.stack.assign(index.roots.rbegin(), index.roots.rend());
  takeCut(
      index, cut.stack, [&](std::uint32_t node) { return hasChildren(index, node) && descend(node); },
      [&](std::uint32_t node) { cut.tiles.push_back({node}); });
  gather(index, cut);
}

}  // namespace

double staticLodDistancePerError(const StaticLodParameters& parameters, double lodScale,
                                 double pixelsPerRadian) {
  const double perError = parameters.rule == StaticDistanceRule::picture
                              ? pixelsPerRadian / parameters.errorPx.value()
                              : parameters.distancePerError.value();
  return perError / lodScale;
}

StaticLodRule staticLodRuleOf(const FrameRequest& request) {
  const FrameLevers& levers = request.levers.drawn;
  StaticLodParameters parameters = request.staticLod;
  parameters.errorPx = Pixels{levers.treeErrorPx};
  return {staticLodDistancePerError(parameters, levers.lodScale, errorPxPerRadian(request)),
          levers.levelSpread, request.spreadFrom.value()};
}

std::vector<float> staticLodError(const StaticLodIndex& index, ErrorMeasure measure) {
  std::vector<float> error = measure == ErrorMeasure::maximum ? index.maxErrorM : index.rmsErrorM;
  if (measure != ErrorMeasure::as_published)
    std::transform(error.begin(), error.end(), index.borderErrorM.begin(), error.begin(),
                   [](float vertical, float border) { return std::max(vertical, border); });
  return error;
}

void selectStatic(const StaticLodIndex& index, std::span<const float> error, const StaticLodRule& rule,
                  Vec3 eye, LevelCut& cut) {
  const double square = rule.distancePerError * rule.distancePerError;
  walk(index, cut, [&](std::uint32_t node) {
    // Both sides are squared, so that an eye inside the box (distance 0) descends for any error at all.
    // Written so that an eye that is not a number does not descend.
    const double e = double{error[node]};
    return spreadSquared(e * e * square, rule.spread, rule.spreadFromM) >
           distanceSquared(index.bounds[node], eye);
  });
}

void selectStaticDepth(const StaticLodIndex& index, int depth, LevelCut& cut) {
  walk(index, cut, [&](std::uint32_t node) { return index.nodes[node].depth < depth; });
}

void gather(const StaticLodIndex& index, LevelCut& cut) {
  cut.triangles.clear();
  for (const TileDraw& tile : cut.tiles) cut.triangles.push_back(index.nodes[tile.node].triangles);
  gatherCut(index.bounds, {}, cut);
}

StaticLodFrame staticLodFrame(const StaticLodIndex& index, const VisibleSet& visible) {
  StaticLodFrame frame;
  frame.drawn = true;
  for (const TileDraw& tile : visible.tiles) {
    const StaticLodIndex::Node& node = index.nodes[tile.node];
    const std::size_t depth = std::min<std::size_t>(node.depth, StaticLodFrame::kDepths - 1);
    frame.triangles[depth] += node.triangles;
    ++frame.nodes[depth];
  }
  return frame;
}

}  // namespace trimtab
