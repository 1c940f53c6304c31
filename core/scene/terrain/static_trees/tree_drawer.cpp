#include "tree_drawer.h"

#include "core/scene/gl/gl_api.h"
#include "trimtab/frame/frame_request.h"

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

PreparedTerrain TreeDrawer::prepare(const FrameInProgress& frame) {
  begin(frame);
  PreparedTerrain prepared;
  const FrameRequest& r = frame.request;
  prepared.counters = culling_.select(r, r.frozenEye.value_or(frame.eye));
  frame.clock.lap(&FrameCost::select);
  prepared.counters.tilesBuilt = uploadShown();
  prepared.occlusion = culling_.occlusion(r);
  map_ = prepared.occlusion.depthMap;
  mapDrawn_ = map_ && !culling_.hiddenIsKnown();
  prepared.counters.depthMapsDrawn = mapDrawn_;
  nearM_ = r.view.nearM;
  prepared.treePicture = r.overlays.treePicture;
  prepared.lines = tileBounds();
  return prepared;
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
    readMap();
    frame_->clock.lap(&FrameCost::occlusion);
    drawSurface(program, byReason ? std::span(cut()) : std::span(visible).subspan(near));
    drawn_ = shown();
  } else {
    TerrainDrawer::draw(program);
  }
}

void TreeDrawer::readMap() {
  const ViewShape& v = frame_->request.view;
  depths_.resize(static_cast<std::size_t>(v.widthPx) * static_cast<std::size_t>(v.heightPx));
  // The processor reduces it: on a software rasteriser, a shader costs several times as much.
  glReadPixels(0, 0, v.widthPx, v.heightPx, GL_DEPTH_COMPONENT, GL_FLOAT, depths_.data());
  pyramid_.build(depths_, v.widthPx, v.heightPx, map_->widthPx, map_->heightPx);
  culling_.removeHidden(pyramid_);
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

DistanceImage TreeDrawer::readDepthMap() const {
  if (!map_ || pyramid_.width() == 0) return {};
  return distanceImage(pyramid_.depths(), pyramid_.width(), pyramid_.height(), nearM_);
}

}  // namespace trimtab::scene
