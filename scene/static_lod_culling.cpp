#include "trimtab/scene/static_lod_culling.h"

#include <algorithm>

#include "trimtab/terrain/static_lod.h"

namespace trimtab::scene {
namespace {

/// How many different vertices each node's triangles have.
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

}  // namespace

void StaticLodCulling::setTerrain(std::shared_ptr<const terrain::StaticLodTerrain> terrain) {
  terrain_ = std::move(terrain);
  cutKey_.reset();
  cutTiles_.clear();
  visible_ = {};
  vertices_ = terrain_ ? vertexCounts(*terrain_) : std::vector<std::uint32_t>{};
}

const StaticLodIndex& StaticLodCulling::index() const {
  return terrain_->index;
}

bool StaticLodCulling::wanted(const FrameRequest& request) const {
  return terrain_ && asksForTrees(request);
}

void StaticLodCulling::select(const FrameRequest& request, const EyePose& eye, FrameResult& counters) {
  const ViewShape& v = request.view;
  const double pixelsPerRadian = std::max(v.widthPx / (v.right - v.left), v.heightPx / (v.top - v.bottom));
  const CutKey key{eye.position, request.staticLod.error,
                   staticLodDistancePerError(request.staticLod, request.decision.lodScale, pixelsPerRadian),
                   request.overlays.treeDepth};
  if (cutKey_ != key) {
    if (key.depth >= 0)
      selectStaticDepth(index(), key.depth, cut_);
    else
      selectStatic(index(), staticLodError(index(), key.error), key.distancePerError, key.eye, cut_);
    cutTiles_.clear();
    for (const std::uint32_t node : cut_.nodes) cutTiles_.push_back({node, 0});
    cutKey_ = key;
    ++counters.cutsSelected;
  }
  selectStaticVisible(index(), vertices_, cut_, eye, v, request.method != CullingCase::none, visible_,
                      request.decision.weather.farM);
}

void StaticLodCulling::removeHidden(std::span<const std::uint8_t> flags) {
  removeStaticOccluded(index(), vertices_, flags, visible_);
}

}  // namespace trimtab::scene
