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

PreparedTerrain TileDrawer::prepare(const FrameInProgress& frame) {
  begin(frame);
  PreparedTerrain prepared;
  const FrameRequest& r = frame.request;
  culling_.selectCut(r, r.frozenEye.value_or(frame.eye));
  frame.clock.lap(&FrameCost::select);
  const OcclusionStage& occlusion = culling_.occlusion();
  culling_.beginOcclusion(r);
  frame.clock.lap(occlusion.horizonServes() ? &FrameCost::occlusion : &FrameCost::select);
  const bool anew = culling_.selectVisible(r);
  frame.clock.lap(&FrameCost::select);
  if (anew) culling_.removeHiddenByMap(r);
  if (occlusion.mapServes()) frame.clock.lap(&FrameCost::occlusion);
  const std::size_t built = uploadShown();
  prepared.depth = culling_.prepareOcclusion(r, gl_->tiles, gl_->occlusion);
  frame.clock.lap(prepared.depth ? &FrameCost::occlusion : &FrameCost::select);
  prepared.occlusion = culling_.result();
  prepared.counters = culling_.counters();
  prepared.counters.tilesBuilt = built;
  prepared.oneSided = r.backFaces && occlusion.eyeIsAboveGround() && !r.frozenEye;
  prepared.lines = tileBounds();
  return prepared;
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
