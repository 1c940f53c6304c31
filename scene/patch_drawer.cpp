#include "trimtab/scene/patch_drawer.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "trimtab/culling/box_distance.h"
#include "trimtab/scene/gl_api.h"
#include "trimtab/scene/gl_report.h"

namespace trimtab::scene {
namespace {

/// Of the ground's colours, a frame; about a millisecond.
constexpr std::size_t kGroundBytesAFrame = 4 << 20;

}  // namespace

void PatchDrawer::setTerrain(std::shared_ptr<const terrain::Database> database) {
  database_ = std::move(database);
  terrain_ = database_ ? database_->patches() : nullptr;
  culling_.setTerrain(terrain_);
  horizon_.setTerrain(database_);
  if (gl_) setGl();
}

void PatchDrawer::initialize() {
  gl_ = std::make_unique<Gl>();
  subpixelBits_ = subpixelBitsOfContext();
  setGl();
}

void PatchDrawer::setGl() {
  gl_->layer.setTerrain(terrain_ ? &terrain_->index() : nullptr);
  gl_->ground.setGround(terrain_ ? database_->ground() : nullptr);
}

int PatchDrawer::levelOf(TileDraw patch) const {
  return terrain_->index().depth[patch.node];
}

void PatchDrawer::prepare(FrameInProgress& frame) {
  begin(frame);
  const FrameRequest& r = frame.request;
  const EyePose eye = r.frozenEye.value_or(frame.view.eye);
  const std::uint64_t before = frame.counters.paging.pagesRead;
  culling_.page(r, eye, gl_->layer, frame.counters);
  frame.clock.lap(before != frame.counters.paging.pagesRead ? &FrameCost::page : &FrameCost::select);
  const std::string refusal = horizon_.refusal(culling_, eye, r.view);
  const std::span<const std::uint8_t> hidden = findHidden(frame, eye, refusal);
  frame.clock.lap(frame.counters.horizon ? &FrameCost::occlusion : &FrameCost::select);
  culling_.selectVisible(r, eye, hidden);
  frame.clock.lap(&FrameCost::select);
  updateGround();
  frame.counters.patches = true;
  frame.view.oneSided = refusal.empty() && !r.frozenEye;
  addBounds();
}

std::span<const std::uint8_t> PatchDrawer::findHidden(FrameInProgress& frame, const EyePose& eye,
                                                      const std::string& refusal) {
  const FrameRequest& r = frame.request;
  horizonView_.reset();
  if (r.method != CullingCase::proposed || !r.decision.depthMap) return {};
  FrameResult& counters = frame.counters;
  counters.note = refusal;
  if (!refusal.empty()) return {};
  horizonView_ = {eye, r.view, *r.decision.depthMap};
  const std::uint64_t built = horizon_.memory().built(), leftOut = horizon_.memory().leftOut();
  const auto hidden =
      horizon_.hidden(culling_, culling_.cutNumber(), eye.position,
                      {HorizonMemory::columnsFor(horizonView_->size.widthPx),
                       HorizonMemory::slackOf(r.view, subpixelBits_), defects_.loweringScale < 1},
                      r.skips);
  counters.horizon = true;
  counters.occlusion = OcclusionMethod::horizon;
  counters.horizonsBuilt += horizon_.memory().built() - built;
  counters.horizonsLeftOut += horizon_.memory().leftOut() - leftOut;
  return hidden;
}

Renderer::Grey PatchDrawer::readDepthMap() const {
  if (!horizonView_) return {};
  const auto& [eye, view, size] = *horizonView_;
  return horizon_.memory().picture(eye, view, size.widthPx, size.heightPx);
}

void PatchDrawer::plant(const Defects& defects) {
  defects_ = defects;
  culling_.plant(defects);
}

void PatchDrawer::updateGround() {
  const terrain::TerrainInfo& info = database_->info();
  const GeodeticPosition& eye = frame_->request.eye;
  const double east = wrapped180(eye.longitude - info.southWest.longitude).value(),
               north = (eye.latitude - info.southWest.latitude).value();
  const std::uint64_t before = gl_->ground.bytesUploaded();
  gl_->ground.showVoids(frame_->request.overlays.voids);
  gl_->ground.update(east / info.postLongitude.value(), north / info.postLatitude.value(),
                     frame_->request.waitForPages, kGroundBytesAFrame);
  frame_->counters.paging.failed += gl_->ground.failed();
  frame_->counters.paging.settled = frame_->counters.paging.waiting == 0 && gl_->ground.complete();
  frame_->clock.lap(before != gl_->ground.bytesUploaded() ? &FrameCost::page : &FrameCost::select);
}

Findings PatchDrawer::failures() const {
  Findings all = culling_.failures();
  if (gl_)
    for (Finding& finding : gl_->ground.failures()) all.push_back(std::move(finding));
  return all;
}

/// Near ones first, as they hide others; equal ones by number.
void PatchDrawer::arrange(std::vector<TileDraw>& patches, Vec3 eye) const {
  places_.clear();
  for (const TileDraw& patch : patches)
    places_.push_back({static_cast<float>(distanceSquared(bounds()[patch.node], eye)), patch});
  std::sort(places_.begin(), places_.end(), [](const Place& a, const Place& b) {
    return std::tie(a.distance, a.patch.node) < std::tie(b.distance, b.patch.node);
  });
  std::transform(places_.begin(), places_.end(), patches.begin(), [](const Place& p) { return p.patch; });
}

void PatchDrawer::drawNodes(unsigned program, std::span<const TileDraw> patches) {
  const BoundSlots slots(gl_->layer.slotTexture(), gl_->layer.tintTexture());
  glUniform2i(glGetUniformLocation(program, "eyePost"), gl_->ground.eyeColumn(), gl_->ground.eyeRow());
  gl_->ground.bind(program);
  gl_->layer.draw(patches);
  gl_->ground.unbind();
}

void PatchDrawer::drawTinted(unsigned program, std::span<const TileDraw> patches,
                             std::span<const std::uint32_t> colours) {
  gl_->layer.setTints(patches, colours);
  drawNodes(program, patches);
}

}  // namespace trimtab::scene
