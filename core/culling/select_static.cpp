#include "trimtab/culling/select_static.h"

#include <algorithm>
#include <memory>

#include "trimtab/culling/box_distance.h"
#include "trimtab/culling/frustum.h"
#include "visible_walk.h"

namespace trimtab {
namespace {

void pushRoots(const StaticLodIndex& index, std::vector<std::uint32_t>& stack) {
  stack.assign(index.roots.rbegin(), index.roots.rend());
}

bool isLeaf(const StaticLodIndex::Node& node) {
  return node.children[0] == StaticLodIndex::kNone;
}

/// Walks the trees from the roots; `descend` says whether a node's children are drawn instead of it.
template <class Descend>
void walk(const StaticLodIndex& index, StaticCut& cut, const Descend& descend) {
  cut.nodes.clear();
  pushRoots(index, cut.stack);
  while (!cut.stack.empty()) {
    const std::uint32_t node = cut.stack.back();
    cut.stack.pop_back();
    const StaticLodIndex::Node& n = index.nodes[node];
    if (isLeaf(n) || !descend(node)) {
      cut.nodes.push_back(node);
      continue;
    }
    cut.stack.push_back(n.children[1]);
    cut.stack.push_back(n.children[0]);
  }
}

void count(const StaticLodIndex& index, std::span<const std::uint32_t> vertices, std::uint32_t node,
           VisibleSet& visible, bool add) {
  const std::uint64_t triangles = index.nodes[node].triangles;
  const std::uint64_t points = node < vertices.size() ? vertices[node] : 0;
  visible.triangles = add ? visible.triangles + triangles : visible.triangles - triangles;
  visible.vertices = add ? visible.vertices + points : visible.vertices - points;
}

}  // namespace

double staticLodDistancePerError(const StaticLodParameters& parameters, double lodScale,
                                 double pixelsPerRadian) {
  const double perError = parameters.rule == StaticDistanceRule::picture
                              ? pixelsPerRadian / parameters.errorPx.value()
                              : parameters.distancePerError.value();
  return perError / lodScale;
}

std::vector<float> staticLodError(const StaticLodIndex& index, ErrorMeasure measure) {
  std::vector<float> error = measure == ErrorMeasure::maximum ? index.maxErrorM : index.rmsErrorM;
  if (measure != ErrorMeasure::as_published)
    std::transform(error.begin(), error.end(), index.borderErrorM.begin(), error.begin(),
                   [](float vertical, float border) { return std::max(vertical, border); });
  return error;
}

void selectStatic(const StaticLodIndex& index, std::span<const float> error, double distancePerError,
                  Vec3 eye, StaticCut& cut) {
  const double square = distancePerError * distancePerError;
  walk(index, cut, [&](std::uint32_t node) {
    // Both sides are squared, so that an eye inside the box (distance 0) descends for any error at all.
    // Written so that an eye that is not a number does not descend.
    const double e = double{error[node]};
    return e * e * square > distanceSquared(index.bounds[node], eye);
  });
}

void selectStaticDepth(const StaticLodIndex& index, int depth, StaticCut& cut) {
  walk(index, cut, [&](std::uint32_t node) { return index.nodes[node].depth < depth; });
}

void selectStaticVisible(const StaticLodIndex& index, std::span<const std::uint32_t> vertices,
                         const StaticCut& cut, const EyePose& eye, const ViewShape& view, bool test,
                         VisibleSet& visible, double farM) {
  visible.tiles.clear();
  visible.reason.clear();
  if (!visible.nodes || *visible.nodes != cut.nodes)
    visible.nodes = std::make_shared<const std::vector<std::uint32_t>>(cut.nodes);
  visible.outsideFrustum = visible.occluded = visible.beyondVisibility = visible.backFacing = 0;
  visible.triangles = visible.vertices = 0;
  const Frustum frustum(eye, view);
  for (const std::uint32_t node : cut.nodes) {
    const Box& box = index.bounds[node];
    CullReason reason = CullReason::drawn;
    if (test && !frustum.mayShow(box)) {
      reason = CullReason::outside_frustum;
      ++visible.outsideFrustum;
    } else if (test && isBeyond(box, eye.position, farM)) {
      reason = CullReason::beyond_visibility;
      ++visible.beyondVisibility;
    } else {
      visible.tiles.push_back({node, 0});
      count(index, vertices, node, visible, true);
    }
    visible.reason.push_back(reason);
  }
}

void removeStaticOccluded(const StaticLodIndex& index, std::span<const std::uint32_t> vertices,
                          std::span<const std::uint8_t> flags, VisibleSet& visible) {
  removeFlagged(flags, visible,
                [&](std::size_t, TileDraw tile) { count(index, vertices, tile.node, visible, false); });
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
