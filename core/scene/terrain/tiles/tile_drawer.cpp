#include "tile_drawer.h"

#include "core/scene/gl/gl_api.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/scene/gl_report.h"

namespace trimtab::scene {

void TileDrawer::setTerrain(std::shared_ptr<const terrain::Database> database) {
  database_ = std::move(database);
  culling_.setDatabase(database_);
  if (gl_) gl_->tiles.setDatabase(database_);
}

void TileDrawer::initialize() {
  gl_ = std::make_unique<Gl>();
  gl_->tiles.setDatabase(database_);
  culling_.occlusion().setSubpixelBits(subpixelBitsOfContext());
}

void TileDrawer::prepare(FrameInProgress& frame) {
  begin(frame);
  const FrameRequest& r = frame.request;
  culling_.selectCut(r, r.frozenEye.value_or(frame.view.eye), frame.counters);
  frame.clock.lap(&FrameCost::select);
  const OcclusionStage& occlusion = culling_.occlusion();
  culling_.beginOcclusion(r, frame.counters);
  frame.clock.lap(occlusion.horizonServes() ? &FrameCost::occlusion : &FrameCost::select);
  const bool anew = culling_.selectVisible(r, frame.counters);
  frame.clock.lap(&FrameCost::select);
  if (anew) culling_.removeHiddenByMap(r, frame.counters);
  if (occlusion.mapServes()) frame.clock.lap(&FrameCost::occlusion);
  uploadShown();
  frame.view.depth = culling_.prepareOcclusion(r, gl_->tiles, gl_->occlusion, frame.counters);
  frame.clock.lap(frame.view.depth ? &FrameCost::occlusion : &FrameCost::select);
  frame.view.oneSided = r.backFaces && occlusion.eyeIsAboveGround() && !r.frozenEye;
  addBounds();
}

void TileDrawer::drawOccluders() {
  gl_->occlusion.beginDepth();
  const BoundSlots slots(gl_->tiles.slotTexture(), gl_->tiles.tintTexture());
  gl_->tiles.drawOccluders(culling_.occluders());
}

void TileDrawer::drawNodes(unsigned, std::span<const TileDraw> nodes) {
  const BoundSlots slots(gl_->tiles.slotTexture(), gl_->tiles.tintTexture());
  gl_->tiles.draw(nodes);
}

void TileDrawer::drawTinted(unsigned program, std::span<const TileDraw> nodes,
                            std::span<const std::uint32_t> colours) {
  gl_->tiles.setTints(nodes, colours);
  drawNodes(program, nodes);
}

}  // namespace trimtab::scene
