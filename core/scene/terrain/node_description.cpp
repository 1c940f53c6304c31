#include "trimtab/scene/node_description.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "trimtab/culling/box_distance.h"
#include "trimtab/terrain/format/patch_terrain.h"
#include "trimtab/terrain/format/static_lod_terrain.h"

namespace trimtab::scene {
namespace {

struct Described {
  NodeDescription node;
  Box box;
};

std::optional<Described> ofTree(std::uint32_t node, const StaticLodIndex& index) {
  if (node >= index.size()) return std::nullopt;
  return Described{{.form = "tree node",
                    .level = index.nodes[node].depth,
                    .triangles = index.nodes[node].triangles,
                    .errorM = index.maxErrorM[node]},
                   index.bounds[node]};
}

/// A patch that is not drawn has no variant in use: its finest one is described.
std::optional<Described> ofPatch(std::uint32_t node, const PatchIndex& index, const VisibleSet& visible) {
  if (node >= index.size()) return std::nullopt;
  const auto drawn = std::find_if(visible.tiles.begin(), visible.tiles.end(),
                                  [node](const TileDraw& d) { return d.node == node; });
  const std::size_t variant = drawn == visible.tiles.end() ? 0 : drawn->variant.number;
  return Described{{.form = "patch",
                    .level = index.depth[node],
                    .triangles = index.triangles[node][variant],
                    .errorM = index.errorM[node][variant]},
                   index.bounds[node]};
}

std::optional<Described> ofTile(std::uint32_t node, const TerrainIndex& index) {
  if (node >= index.size()) return std::nullopt;
  return Described{{.form = "tile",
                    .level = index.level[node],
                    .triangles = 2 * TerrainIndex::kTileCells * TerrainIndex::kTileCells,
                    .errorM = index.errorM[node]},
                   index.bounds[node]};
}

/// A corner behind the eye has no place in the image: its box is assumed to reach to the image's edges.
void measureInImage(const Box& box, const EyePose& eye, const ViewShape& view, NodeDescription& node) {
  double left = 1e9, right = -1e9, low = 1e9, high = -1e9;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 place{corner & 1 ? box.maxX : box.minX, corner & 2 ? box.maxY : box.minY,
                     corner & 4 ? box.maxZ : box.minZ};
    const Vec3 seen = eye.axes * (place - eye.position);
    const double depth = -seen.z;
    const bool behind = !(depth > view.nearM);
    left = std::min(left, behind ? view.left : seen.x / depth);
    right = std::max(right, behind ? view.right : seen.x / depth);
    low = std::min(low, behind ? view.bottom : seen.y / depth);
    high = std::max(high, behind ? view.top : seen.y / depth);
  }
  const double width = std::min(right, view.right) - std::max(left, view.left),
               height = std::min(high, view.top) - std::max(low, view.bottom);
  node.widthPx = std::max(0.0, width) * view.widthPx / (view.right - view.left);
  node.heightPx = std::max(0.0, height) * view.heightPx / (view.top - view.bottom);
}

}  // namespace

std::optional<NodeDescription> describeNode(std::uint32_t node, const terrain::Database& database,
                                            const FrameRequest& request, const FrameResult& result) {
  const auto trees = database.staticLod();
  const auto patches = database.patches();
  std::optional<Described> described;
  if (result.staticLod.drawn)
    described = trees ? ofTree(node, trees->index) : std::nullopt;
  else if (result.patches)
    described = patches ? ofPatch(node, patches->index(), result.visible) : std::nullopt;
  else
    described = ofTile(node, database.index());
  if (!described) return std::nullopt;

  NodeDescription& found = described->node;
  const LocalFrame& frame = database.index().frame;
  const EyePose eye{frame.fromGeodetic(request.eye), eyeAxes(frame, request.eye, request.attitude)};
  const ViewShape& view = request.view;
  found.distanceM = std::sqrt(distanceSquared(described->box, eye.position));
  found.errorPx = found.errorM / std::max(found.distanceM, view.nearM) * pixelsPerRadian(view);
  measureInImage(described->box, eye, view, found);
  found.reason = result.visible.reasonOf(node);
  found.bounds = described->box;
  return found;
}

std::string_view inWords(CullReason reason) {
  constexpr std::array<std::string_view, 6> kWords{"drawn",
                                                   "outside the frustum",
                                                   "occluded by ground in front of it",
                                                   "beyond visibility",
                                                   "all of it faces away",
                                                   "another level is drawn in its place"};
  static_assert(static_cast<std::size_t>(CullReason::other_level) + 1 == kWords.size());
  return kWords[static_cast<std::size_t>(reason)];
}

}  // namespace trimtab::scene
