#include "tile_drawer.h"

#include <algorithm>
#include <cmath>

#include "core/scene/gl/gl_api.h"
#include "trimtab/culling/box_distance.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/scene/gl_report.h"
#include "trimtab/terrain/format/object_terrain.h"

namespace trimtab::scene {

void TileDrawer::setTerrain(std::shared_ptr<const terrain::Database> database) {
  database_ = std::move(database);
  cutKey_.reset();
  cut_.tiles.clear();
  ++cutNumber_.cut;
  ground_.setDatabase(database_);
  ground_.setCut(cut_, cutNumber_);
  occlusion_.clear();
  mapDrawn_ = false;
  if (gl_) gl_->tiles.setDatabase(database_);
}

void TileDrawer::initialize() {
  gl_ = std::make_unique<Gl>();
  gl_->tiles.setDatabase(database_);
  occlusion_.setSubpixelBits(subpixelBitsOfContext());
}

void TileDrawer::plant(const Defects& defects) {
  defects_ = defects;
  occlusion_.plant(defects);
}

PreparedTerrain TileDrawer::prepare(const FrameInProgress& frame) {
  begin(frame);
  PreparedTerrain prepared;
  const FrameRequest& r = frame.request;
  eye_ = r.frozenEye.value_or(frame.eye);
  const bool cutSelected = selectCut(r);
  frame.clock.lap(&FrameCost::select);
  occlusion_.begin(r, eye_, true);
  frame.clock.lap(occlusion_.serves(OcclusionMethod::horizon) ? &FrameCost::occlusion : &FrameCost::select);
  if (findVisible(occlusion_, cut_, visible_)) visible_.vertices = tileVertices(visible_);
  const std::size_t built = uploadShown();
  prepared.occlusion = occlusion_.result();
  prepared.depth = prepareDepthMap(r, prepared.occlusion.note);
  mapDrawn_ = prepared.depth.has_value();
  nearM_ = r.view.nearM;
  frame.clock.lap(mapDrawn_ ? &FrameCost::occlusion : &FrameCost::select);
  if (mapDrawn_) prepared.occlusion.depthMap = occlusion_.resolution();
  prepared.counters = occlusion_.counters();
  prepared.counters.cutsSelected += cutSelected;
  prepared.counters.depthMapsDrawn += mapDrawn_;
  prepared.counters.tilesBuilt = built;
  prepared.oneSided = r.backFaces && occlusion_.eyeIsAboveGround() && !r.frozenEye;
  prepared.lines = tileBounds();
  prepared.hiddenCells = occlusion_.hiddenBoxes();
  return prepared;
}

bool TileDrawer::selectCut(const FrameRequest& request) {
  const CutKey key = cutKeyOf(request, eye_.position, defects_.statedErrorScale);
  if (cutKey_ == key && request.skips.sameCut) return false;
  selectLevels(database_->index(), key.eye, key.rule, cut_);
  cutNumber_.errorOverDistance = key.rule.errorOverDistance();
  cutNumber_.cut += cutKey_ != key;
  cutNumber_.rule += !cutKey_ || cutKey_->rule != key.rule;
  cutKey_ = key;
  return true;
}

std::optional<DepthView> TileDrawer::prepareDepthMap(const FrameRequest& request, std::string& note) {
  if (!occlusion_.serves(OcclusionMethod::depth_map) || visible_.tiles.empty()) return {};
  const OcclusionResolution size = occlusion_.resolution();
  testedSlots_.clear();
  occluders_.clear();
  // Far tiles cost as much to draw as near ones and hide little. Measured over Everest and Fuji, leaving out
  // tiles narrower than 48 texels loses a few percent of the hidden tiles and saves up to half of the pass.
  const TerrainIndex& index = database_->index();
  const double texelsPerTangent = size.widthPx / (request.view.right - request.view.left);
  const double leastTexels = std::min(48.0, 0.12 * size.widthPx);
  const auto texelsAcross = [&](const Box& b) {
    const Vec3 middle{0.5 * (double{b.minX} + b.maxX), 0.5 * (double{b.minY} + b.maxY),
                      0.5 * (double{b.minZ} + b.maxZ)};
    return (double{b.maxX} - b.minX) * texelsPerTangent / length(middle - eye_.position);
  };
  for (const TileDraw& tile : visible_.tiles) {
    testedSlots_.push_back(gl_->tiles.slotOf(tile.node));
    if (ground_.conditions().mayOcclude(tile.node) && texelsAcross(index.bounds[tile.node]) >= leastTexels)
      occluders_.push_back(tile);
  }
  if (occluders_.empty()) {
    note = "No tile in view may hide another: all are too far away or at the terrain's edge.";
    return {};
  }
  gl_->occlusion.prepare(size.widthPx, size.heightPx, testedSlots_);
  return DepthView{eye_,
                   size.widthPx,
                   size.heightPx,
                   OcclusionPass::kLevels,
                   static_cast<int>(testedSlots_.size()),
                   defects_.loweringScale,
                   defects_.depthMapShiftTexels};
}

std::span<const std::uint8_t> TileDrawer::removeHidden() {
  gl_->occlusion.test(gl_->tiles, flags_);
  removeOccluded(cut_, flags_, visible_);
  visible_.vertices = tileVertices(visible_);
  const auto objects = database_->objects();
  if (!objects) return {};
  // Here and not in the shader, because most cells are settled by a larger one.
  gl_->occlusion.read(depths_);
  const int width = gl_->occlusion.width(), height = gl_->occlusion.height();
  map_.build(depths_, width, height, width, height);
  ViewShape read = frame_->request.view;
  const double shift = defects_.depthMapShiftTexels * (read.right - read.left) / width;
  read.left -= shift;
  read.right -= shift;
  findHiddenCells(objects->index, map_, eye_, read, hiddenCells_);
  return hiddenCells_;
}

void TileDrawer::drawOccluders() {
  gl_->occlusion.beginDepth();
  const BoundSlots slots(gl_->tiles.slotTexture(), gl_->tiles.tintTexture());
  gl_->tiles.drawOccluders(occluders_);
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

DistanceImage TileDrawer::readDepthMap() const {
  if (!mapDrawn_) return occlusion_.picture();
  std::vector<float> depths;
  GLint before = 0;
  glGetIntegerv(GL_READ_FRAMEBUFFER_BINDING, &before);
  gl_->occlusion.read(depths);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, static_cast<GLuint>(before));
  return distanceImage(depths, gl_->occlusion.width(), gl_->occlusion.height(), nearM_);
}

}  // namespace trimtab::scene
