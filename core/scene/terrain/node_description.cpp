#include "trimtab/scene/node_description.h"

#include <algorithm>
#include <cmath>

#include "trimtab/culling/box_distance.h"
#include "trimtab/frame/patch_index.h"
#include "trimtab/terrain/format/patch_terrain.h"
#include "trimtab/terrain/format/static_lod_terrain.h"

namespace trimtab::scene {
namespace {

/// What a form of the terrain itself says about a node.
template <class Index>
bool knows(const Index& index, std::uint32_t node, NodeDescription& about) {
  if (node >= index.size()) return false;
  about.bounds = index.bounds[node];
  return true;
}

bool describeTree(const StaticLodIndex& index, std::uint32_t node, NodeDescription& about) {
  about.form = TerrainForm::static_trees;
  if (!knows(index, node, about)) return false;
  about.level = index.nodes[node].depth;
  about.triangles = index.nodes[node].triangles;
  about.errorM = index.maxErrorM[node];
  return true;
}

bool describePatch(const PatchIndex& index, const VisibleSet& visible, std::uint32_t node,
                   NodeDescription& about) {
  about.form = TerrainForm::patches;
  if (!knows(index, node, about)) return false;
  const auto drawn = std::find_if(visible.tiles.begin(), visible.tiles.end(),
                                  [node](const TileDraw& d) { return d.node == node; });
  const std::size_t variant = drawn == visible.tiles.end() ? 0 : drawn->variant.number;
  about.level = index.depth[node];
  about.triangles = index.triangles[node][variant];
  about.errorM = index.errorM[node][variant];
  return true;
}

bool describeTile(const TerrainIndex& index, std::uint32_t node, NodeDescription& about) {
  if (!knows(index, node, about)) return false;
  about.level = index.level[node];
  about.triangles = 2 * TerrainIndex::kTileCells * TerrainIndex::kTileCells;
  about.errorM = index.errorM[node];
  return true;
}

}  // namespace

std::optional<NodeDescription> describeNode(const terrain::Database& database, const FrameRequest& request,
                                            const FrameResult& drawn, std::uint32_t node) {
  NodeDescription about;
  const bool known =
      drawn.staticLod.drawn ? database.staticLod() && describeTree(database.staticLod()->index, node, about)
      : drawn.patches
          ? database.patches() && describePatch(database.patches()->index(), drawn.visible, node, about)
          : describeTile(database.index(), node, about);
  if (!known) return {};
  const Vec3 eye = database.index().frame.fromGeodetic(request.eye);
  about.distanceM = std::sqrt(distanceSquared(about.bounds, eye));
  about.errorPx =
      about.errorM / std::max(about.distanceM, request.view.nearM) * pixelsPerRadian(request.view);
  about.reason = drawn.visible.reasonOf(node);
  return about;
}

}  // namespace trimtab::scene
