#include "patch_drawer.h"

#include <utility>

#include "core/scene/gl/gl_api.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/scene/data_extent.h"
#include "trimtab/scene/gl_report.h"
#include "trimtab/scene/planted_defects.h"

namespace trimtab::scene {
namespace {

/// A frame uploads at most so much of the ground's colours, which takes about a millisecond.
constexpr std::size_t kGroundBytesAFrame = 4 << 20;

}  // namespace

void PatchDrawer::setTerrain(std::shared_ptr<const terrain::Database> database) {
  database_ = std::move(database);
  terrain_ = database_ ? database_->patches() : nullptr;
  culling_.setTerrain(terrain_);
  hiding_.setTerrain(database_);
  occlusion_.clear();
  visible_ = {};
  if (gl_) setGl();
}

void PatchDrawer::initialize() {
  gl_ = std::make_unique<Gl>();
  occlusion_.setSubpixelBits(subpixelBitsOfContext());
  setGl();
}

void PatchDrawer::setGl() {
  gl_->layer.setTerrain(terrain_ ? &terrain_->index() : nullptr);
  gl_->ground.setGround(terrain_ ? database_->ground() : nullptr);
}

int PatchDrawer::levelOf(TileDraw patch) const {
  return terrain_->index().depth[patch.node];
}

PreparedTerrain PatchDrawer::prepare(const FrameInProgress& frame) {
  begin(frame);
  PreparedTerrain prepared;
  const FrameRequest& r = frame.request;
  const EyePose eye = r.frozenEye.value_or(frame.eye);
  const PatchCulling::Paged paged = culling_.page(r, eye, gl_->layer);
  prepared.paging = paged.paging;
  const bool read = std::exchange(pagesRead_, paged.paging.pagesRead) != paged.paging.pagesRead;
  frame.clock.lap(read ? &FrameCost::page : &FrameCost::select);
  occlusion_.begin(r, eye, false);
  frame.clock.lap(occlusion_.serves(OcclusionMethod::horizon) ? &FrameCost::occlusion : &FrameCost::select);
  if (findVisible(occlusion_, culling_.cut(), visible_)) {
    visible_.vertices = 0;
    for (const TileDraw& patch : visible_.tiles) visible_.vertices += terrain_->facts()[patch.node].vertices;
  }
  updateGround(prepared.paging);
  prepared.occlusion = occlusion_.result();
  prepared.counters = occlusion_.counters();
  prepared.counters.cutsSelected = paged.cutsSelected;
  prepared.oneSided = r.backFaces && occlusion_.eyeIsAboveGround() && !r.frozenEye;
  prepared.lines = tileBounds();
  prepared.hiddenCells = occlusion_.hiddenBoxes();
  return prepared;
}

void PatchDrawer::plant(const Defects& defects) {
  occlusion_.plant(defects);
  culling_.plant(defects);
}

void PatchDrawer::updateGround(PagingFrame& paging) {
  const terrain::PostGrid posts = postsOf(database_->info());
  const GeodeticPosition& eye = frame_->request.eye;
  const std::uint64_t before = gl_->ground.bytesUploaded();
  gl_->ground.showVoids(frame_->request.overlays.voids);
  gl_->ground.update(posts.columnOf(eye.longitude.value()), posts.rowOf(eye.latitude.value()),
                     frame_->request.waitForPages, kGroundBytesAFrame);
  paging.failed += gl_->ground.failed();
  paging.settled = paging.waiting == 0 && gl_->ground.complete();
  frame_->clock.lap(before != gl_->ground.bytesUploaded() ? &FrameCost::page : &FrameCost::select);
}

Findings PatchDrawer::failures() const {
  Findings all = culling_.failures();
  if (gl_)
    for (Finding& finding : gl_->ground.failures()) all.push_back(std::move(finding));
  return all;
}

void PatchDrawer::drawNodes(unsigned program, std::span<const TileDraw> patches) {
  const BoundSlots slots(gl_->layer.slotTexture(), gl_->layer.tintTexture());
  glUniform2i(glGetUniformLocation(program, "eyePost"), gl_->ground.eyeColumn(), gl_->ground.eyeRow());
  const FrameRequest& r = frame_->request;
  gl_->ground.bind(program, r.scaleTexture ? r.levers.drawn.lodScale : 1);
  gl_->layer.draw(patches);
  gl_->ground.unbind();
}

void PatchDrawer::drawTinted(unsigned program, std::span<const TileDraw> patches,
                             std::span<const std::uint32_t> colours) {
  gl_->layer.setTints(patches, colours);
  drawNodes(program, patches);
}

}  // namespace trimtab::scene
