#include "terrain_drawer.h"

#include <algorithm>
#include <bit>

#include "core/scene/gl/gl_api.h"
#include "core/scene/gl/guard_band.h"
#include "core/scene/occlusion/occlusion_stage.h"
#include "core/scene/passes/node_pass.h"
#include "core/scene/shaders/shaders.h"
#include "trimtab/culling/back_facing.h"
#include "trimtab/culling/box_distance.h"
#include "trimtab/culling/frustum.h"
#include "trimtab/frame/overlay_colours.h"
#include "trimtab/frame/overlays.h"

namespace trimtab::scene {
void BoundSlots::bind(unsigned slots, unsigned tints) {
  glActiveTexture(GL_TEXTURE0 + kSlotUnit);
  glBindTexture(GL_TEXTURE_BUFFER, slots);
  glActiveTexture(GL_TEXTURE0 + kTintUnit);
  glBindTexture(GL_TEXTURE_BUFFER, tints);
  glActiveTexture(GL_TEXTURE0);
}

void TerrainDrawer::begin(const FrameInProgress& frame) {
  frame_.emplace(frame);
  drawn_.clear();
  frame.clock.lap(&FrameCost::cull);
}

const std::vector<TileDraw>& TerrainDrawer::shown() const {
  return frame_->request.overlays.colourByReason ? cut() : visible().tiles;
}

bool TerrainDrawer::findVisible(OcclusionStage& stage, const LevelCut& cut, VisibleSet& visible) {
  const FrameRequest& r = frame_->request;
  const bool anew = !stage.visibleStays(r);
  if (anew) selectVisible(cut, stage.query(r), visible);
  frame_->clock.lap(&FrameCost::select);
  return anew;
}

std::size_t TerrainDrawer::uploadShown() {
  const std::size_t built = upload(shown(), !frame_->request.skips.tilesOnGpu);
  frame_->clock.lap(built > 0 ? &FrameCost::page : &FrameCost::select);
  return built;
}

std::vector<LineVertex> TerrainDrawer::tileBounds() const {
  std::vector<LineVertex> lines;
  if (frame_->request.overlays.tileBounds)
    addBoxes(bounds(), cut(), visible().reason, frame_->eye.position, lines);
  return lines;
}

void TerrainDrawer::draw(unsigned program) {
  drawn_ = shown();
  arrange(drawn_);
  drawSurface(program, drawn_);
}

void TerrainDrawer::arrange(std::vector<TileDraw>& nodes) const {
  places_.clear();
  const Frustum uncut(frame_->eye, withGuardBand(frame_->shape, frame_->guardBand));
  const std::vector<Box>& boxes = bounds();
  const std::span<const NormalCone> normals = cones();
  const auto isAway = [&](std::uint32_t node) {
    return !normals.empty() && facesAway(normals[node], boxes[node], frame_->eye.position);
  };
  // A distance is not negative: its bits are in order too, also where the eye is no place, and the first of
  // them is free.
  for (TileDraw& node : nodes) {
    const auto distance = static_cast<float>(distanceSquared(boxes[node.node], frame_->eye.position));
    node.bothSides = !uncut.holds(boxes[node.node]) && !isAway(node.node);
    places_.push_back({std::uint64_t{!node.bothSides} << 63 |
                           std::uint64_t{std::bit_cast<std::uint32_t>(distance)} << 32 | node.node,
                       node});
  }
  std::sort(places_.begin(), places_.end(), [](const Place& a, const Place& b) { return a.key < b.key; });
  std::transform(places_.begin(), places_.end(), nodes.begin(), [](const Place& p) { return p.node; });
}

void TerrainDrawer::drawSurface(unsigned program, std::span<const TileDraw> nodes) {
  const Overlays& overlays = frame_->request.overlays;
  if (!overlays.colourByReason && !overlays.colourByLevel) return drawNodes(program, nodes);
  tints_.clear();
  const std::vector<CullReason> reason =
      overlays.colourByReason ? visible().reasons(bounds().size()) : std::vector<CullReason>{};
  for (const TileDraw& node : nodes)
    tints_.push_back(
        overlayTint(overlays.colourByReason ? reasonColour(reason[node.node]) : levelColour(levelOf(node))));
  drawTinted(program, nodes, tints_);
}

void TerrainDrawer::drawWire(unsigned program) {
  glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
  drawNodes(program, drawn_);
  glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
}

std::size_t TerrainDrawer::prepareNumbers(bool unculled) {
  if (!unculled) {
    numbered_ = drawn_;
    return 0;
  }
  nearView(cut(), bounds(), frame_->eye, frame_->shape, numbered_);
  arrange(numbered_);
  return upload(numbered_, false);
}

}  // namespace trimtab::scene
