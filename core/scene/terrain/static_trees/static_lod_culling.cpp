#include "static_lod_culling.h"

#include <algorithm>
#include <cmath>

#include "trimtab/culling/box_distance.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/scene/planted_defects.h"
#include "trimtab/terrain/format/static_lod_terrain.h"

namespace trimtab::scene {
namespace {

/// Returns how many different vertices each node's triangles have.
std::vector<std::uint32_t> vertexCounts(const terrain::StaticLodTerrain& terrain) {
  std::vector<std::uint32_t> counts(terrain.index.size());
  std::vector<std::vector<std::uint32_t>> lastUser(terrain.tiles.size());
  for (std::size_t tile = 0; tile < lastUser.size(); ++tile)
    lastUser[tile].assign(terrain.tiles[tile].vertices.size(), StaticLodIndex::kNone);
  for (std::uint32_t node = 0; node < counts.size(); ++node) {
    const std::uint32_t tile = terrain.index.nodes[node].tile;
    const terrain::StaticLodRange range = terrain.ranges[node];
    const std::vector<std::uint32_t>& indices = terrain.tiles[tile].indices;
    for (std::size_t i = 3 * std::size_t{range.firstTriangle}, end = i + 3 * std::size_t{range.triangles};
         i < end; ++i) {
      std::uint32_t& user = lastUser[tile][indices[i]];
      counts[node] += user != node;
      user = node;
    }
  }
  return counts;
}

/// One node in so many of the cut is near: drawn first, and what it covers is read.
constexpr std::size_t kNearOneIn = 3;

}  // namespace

void StaticLodCulling::setTerrain(std::shared_ptr<const terrain::StaticLodTerrain> terrain) {
  terrain_ = std::move(terrain);
  parts_.setTerrain(terrain_.get());
  cutKey_.reset();
  errors_.clear();
  visibleKey_.reset();
  cut_.tiles.clear();
  visible_ = {};
  vertices_ = terrain_ ? vertexCounts(*terrain_) : std::vector<std::uint32_t>{};
}

const StaticLodIndex& StaticLodCulling::index() const {
  return terrain_->index;
}

FrameCounters StaticLodCulling::select(const FrameRequest& request, const EyePose& eye) {
  FrameCounters counters;
  const ViewShape& v = request.view;
  TreeCutKey key{eye.position, request.staticLod.error, staticLodRuleOf(request), request.overlays.treeDepth};
  key.rule.distancePerError *= defects_.statedErrorScale;
  if (cutKey_ != key || !request.skips.sameCut) {
    if (key.depth >= 0)
      selectStaticDepth(index(), key.depth, cut_);
    else {
      if (errors_.empty() || !cutKey_ || cutKey_->error != key.error)
        errors_ = staticLodError(index(), key.error);
      selectStatic(index(), errors_, key.rule, key.eye, cut_);
    }
    orderByDistance(eye.position);
    cutKey_ = key;
    ++counters.cutsSelected;
  }
  const double farM = farCutM(request);
  const VisibleKey wanted{
      key, eye, v, request.cullingCase, request.levers.drawn.occlusion, farM, request.overlays.treePicture};
  // Frozen, what was hidden from there stays hidden: the image is another eye's and cannot show what is
  // hidden from this one.
  if (visibleKey_ == wanted && (request.frozenEye || request.skips.sameVisible)) return counters;
  visibleKey_ = wanted;
  hiddenIsKnown_ = false;
  ++counters.visibleSelected;
  selectVisible(cut_, {.eye = eye, .view = v, .cull = request.cullingCase != CullingCase::none, .farM = farM},
                visible_);
  if (defects_.culledNode) {
    flags_.clear();
    for (const TileDraw& node : visible_.tiles) flags_.push_back(node.node == defects_.culledNode);
    removeOccluded(cut_, flags_, visible_);
  }
  countVertices();
  visibleNear_ = static_cast<std::size_t>(
      std::count(visible_.reason.begin(), visible_.reason.begin() + static_cast<std::ptrdiff_t>(near_),
                 CullReason::drawn));
  return counters;
}

/// Puts the near part of the cut first, both parts in the trees' order.
void StaticLodCulling::orderByDistance(Vec3 eye) {
  std::vector<TileDraw>& nodes = cut_.tiles;
  near_ = nodes.size() / kNearOneIn;
  if (near_ == 0) return;
  distances_.clear();
  for (const TileDraw& node : nodes) distances_.push_back(distanceSquared(index().bounds[node.node], eye));
  const auto middle = distances_.begin() + static_cast<std::ptrdiff_t>(near_);
  std::nth_element(distances_.begin(), middle, distances_.end());
  const double limit = *middle;
  far_.clear();
  std::size_t kept = 0;
  for (const TileDraw& node : nodes)
    if (distanceSquared(index().bounds[node.node], eye) < limit)
      nodes[kept++] = node;
    else
      far_.push_back(node);
  std::copy(far_.begin(), far_.end(), nodes.begin() + static_cast<std::ptrdiff_t>(kept));
  near_ = kept;
  gather(index(), cut_);
}

/// Triangles of far nodes in view whose tops lie below the steepest line of sight to a near node's top: no
/// others can be hidden. A guess at what a map may win, which is nothing once the eye is high.
std::uint64_t StaticLodCulling::hideableTriangles(Vec3 eye) const {
  double steepestNear = -1e300;
  std::uint64_t triangles = 0;
  for (std::size_t i = 0; i < visible_.tiles.size(); ++i) {
    const std::uint32_t node = visible_.tiles[i].node;
    const Box& b = index().bounds[node];
    const double up = b.maxZ - eye.z;
    const bool near = i < visibleNear_;
    // The end of a near node's box is the one that gives the steeper line; of a far node's box it is the one
    // that gives the flatter.
    const double x = std::max(std::abs(b.minX - eye.x), std::abs(b.maxX - eye.x)),
                 y = std::max(std::abs(b.minY - eye.y), std::abs(b.maxY - eye.y));
    const double away = (up > 0) == near
                            ? std::sqrt(distanceSquared({b.minX, b.minY, -1e9f, b.maxX, b.maxY, 1e9f}, eye))
                            : std::hypot(x, y);
    const double slope = up / std::max(away, 1.0);
    if (near)
      steepestNear = std::max(steepestNear, slope);
    else if (slope < steepestNear)
      triangles += index().nodes[node].triangles;
  }
  return triangles;
}

OcclusionResult StaticLodCulling::occlusion(const FrameRequest& request) const {
  OcclusionResult result;
  const std::optional<OcclusionResolution>& size = request.levers.drawn.occlusion;
  if (request.cullingCase != CullingCase::proposed || !size || request.overlays.treePicture) return {};
  if (request.frozenEye)
    result.note = "What is hidden stays as it was when culling was frozen.";
  else if (!hiddenIsKnown_ && static_cast<double>(hideableTriangles(visibleKey_->eye.position)) <
                                  request.staticLod.mapFromTriangles.value())
    result.note = "Too few triangles of the static trees can be hidden for a depth map to be drawn.";
  if (!result.note.empty()) return result;
  result.depthMap = size;
  result.occlusion = OcclusionMethod::depth_map;
  return result;
}

void StaticLodCulling::removeHidden(const DepthPyramid& covered) {
  flags_.assign(visible_.tiles.size(), 0);
  for (std::size_t i = visibleNear_; i < flags_.size(); ++i) {
    const std::span<const Box> parts = parts_.of(visible_.tiles[i].node);
    flags_[i] = std::all_of(parts.begin(), parts.end(), [&](const Box& part) {
      return covered.isHidden(part, visibleKey_->eye, visibleKey_->view);
    });
  }
  removeOccluded(cut_, flags_, visible_);
  countVertices();
  hiddenIsKnown_ = true;
}

void StaticLodCulling::countVertices() {
  visible_.vertices = 0;
  for (const TileDraw& node : visible_.tiles) visible_.vertices += vertices_[node.node];
}

void StaticLodCulling::plant(const Defects& defects) {
  defects_ = defects;
  visibleKey_.reset();
}

}  // namespace trimtab::scene
