#include "tree_drawer.h"

#include "core/scene/gl/gl_api.h"
#include "core/scene/occlusion/frame_culling.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/terrain/format/static_lod_terrain.h"

namespace trimtab::scene {

void TreeDrawer::setTerrain(std::shared_ptr<const terrain::Database> database) {
  terrain_ = database ? database->staticLod() : nullptr;
  culling_.setTerrain(terrain_);
  if (gl_) gl_->layer.setTerrain(terrain_);
}

void TreeDrawer::initialize() {
  gl_ = std::make_unique<Gl>();
  gl_->layer.setTerrain(terrain_);
}

void TreeDrawer::prepare(FrameInProgress& frame) {
  begin(frame);
  const FrameRequest& r = frame.request;
  culling_.select(r, r.frozenEye.value_or(frame.view.eye), frame.counters);
  frame.clock.lap(&FrameCost::select);
  uploadShown();
  frame.counters.depthMap = culling_.occlusion(r, frame.counters);
  mapServes_ = frame.counters.depthMap.has_value();
  mapDrawn_ = mapServes_ && !culling_.hiddenIsKnown();
  frame.counters.depthMapsDrawn += mapDrawn_;
  if (mapServes_) frame.counters.occlusion = OcclusionMethod::depth_map;
  nearM_ = r.view.nearM;
  frame.view.treePicture = r.overlays.treePicture;
  addBounds();
}

void TreeDrawer::draw(unsigned program) {
  if (mapDrawn_) {
    const bool byReason = frame_->request.overlays.colourByReason;
    const std::vector<TileDraw>& visible = culling_.visible().tiles;
    const std::size_t near = culling_.visibleNear();
    drawSurface(program, std::span(visible).first(near));
    // Reading waits for the near nodes: a software rasteriser's time for them is not the map's.
    if (frame_->software) glFinish();
    frame_->clock.lap(&FrameCost::draw);
    const ViewShape& v = frame_->request.view;
    const DepthMapSize& size = *frame_->counters.depthMap;
    gl_->occlusion.read(v.widthPx, v.heightPx, size.widthPx, size.heightPx);
    culling_.removeHidden(gl_->occlusion.pyramid());
    frame_->clock.lap(&FrameCost::occlusion);
    drawSurface(program, byReason ? std::span(cut()) : std::span(visible).subspan(near));
    drawn_ = shown();
  } else {
    TerrainDrawer::draw(program);
  }
}

void TreeDrawer::drawPicture(unsigned program) {
  const BoundSlots slots(gl_->layer.slotTexture(), 0);
  gl_->layer.drawPicture(program, visible().tiles);
}

void TreeDrawer::drawNumbered(unsigned) {
  const BoundSlots slots(gl_->layer.slotTexture(), 0);
  gl_->layer.drawNumbered(numbered_);
}

void TreeDrawer::drawNodes(unsigned, std::span<const TileDraw> nodes) {
  const BoundSlots slots(gl_->layer.slotTexture(), 0);
  gl_->layer.draw(nodes);
}

void TreeDrawer::drawTinted(unsigned, std::span<const TileDraw> nodes,
                            std::span<const std::uint32_t> colours) {
  const BoundSlots slots(gl_->layer.slotTexture(), 0);
  gl_->layer.drawNumbered(nodes, colours);
}

Renderer::Grey TreeDrawer::readDepthMap() const {
  const DepthPyramid& map = gl_->occlusion.pyramid();
  if (!mapServes_ || map.width() == 0) return {};
  return greyOf(map.depths(), map.width(), map.height(), nearM_);
}

}  // namespace trimtab::scene
