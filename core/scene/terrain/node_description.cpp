#include "trimtab/scene/node_description.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "trimtab/culling/box_distance.h"
#include "trimtab/culling/cut_rule.h"
#include "trimtab/culling/select_objects.h"
#include "trimtab/terrain/format/object_terrain.h"
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

EyePose eyeOf(const FrameRequest& request, const LocalFrame& frame) {
  return {frame.fromGeodetic(request.eye), eyeAxes(frame, request.eye, request.attitude)};
}

/// Fills what follows from the bounds, the error and the view.
void measure(NodeDescription& node, const EyePose& eye, const ViewShape& view) {
  node.distanceM = std::sqrt(distanceSquared(node.bounds, eye.position));
  node.errorPx = node.errorM / std::max(node.distanceM, view.nearM) * pixelsPerRadian(view);
  measureInImage(node.bounds, eye, view, node);
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
  found.reason = result.visible.reasonOf(node);
  found.bounds = described->box;
  measure(found, eyeOf(request, database.index().frame), request.view);
  return found;
}

std::optional<NodeDescription> describeObject(std::uint32_t instance, const terrain::Database& database,
                                              const FrameRequest& request) {
  const auto objects = database.objects();
  if (!objects || instance >= objects->index.instances.size()) return std::nullopt;
  const ObjectIndex& index = objects->index;
  const ObjectInstance& object = index.instances[instance];
  const ObjectIndex::Model& model = index.models[object.model];
  const Vec3 foot = placeOfObject(index, instance);
  const EyePose eye = eyeOf(request, index.frame);
  const double distance = length(foot - eye.position);
  const std::uint32_t level = levelOfObject(index, object, distance, objectRuleOf(request));
  const double radius = double{model.radiusM} * object.scale;
  const auto outwards = [&](double at, double by) { return static_cast<float>(at + by); };
  NodeDescription found{
      .form = "object",
      .model = objects->names[object.model],
      .level = static_cast<int>(level - model.firstLevel),
      .triangles = index.levels[level].triangles,
      .errorM = double{index.levels[level].errorM} * object.scale,
      .reason = CullReason::drawn,
      .bounds = {outwards(foot.x, -radius), outwards(foot.y, -radius), outwards(foot.z, -radius),
                 outwards(foot.x, radius), outwards(foot.y, radius), outwards(foot.z, radius)}};
  measure(found, eye, request.view);
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
