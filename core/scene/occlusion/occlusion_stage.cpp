#include "occlusion_stage.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/scene/planted_defects.h"
#include "trimtab/units/not_finite.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace trimtab::scene {
namespace {

/// A frame for which many surfaces are missing says nothing about what the horizon is worth, unless so many
/// follow each other.
constexpr int kUnlearntFrames = 600;

constexpr const char* kNothingPays = "Finding hidden ground is not worth its cost here.";
constexpr const char* kNoGpuMap = "Patches have no depth map on the GPU; the horizon serves instead.";
constexpr const char* kNoGraph =
    "Some of this ground is vertical or overhangs, or is not loaded yet, so there is no horizon.";

/// Returns the occlusion resolution that the band asks for; unset if the scheme asks for no occlusion test.
std::optional<OcclusionResolution> occlusionResolution(const FrameRequest& request) {
  if (request.cullingCase != CullingCase::proposed) return {};
  const std::optional<OcclusionResolution>& asked = request.levers.drawn.occlusion;
  if (asked || request.skips.schemeFrustum) return asked;
  const Band& smallest = kDepthMapBands.span().front();
  return OcclusionResolution{smallest.widthPx, smallest.heightPx};
}

Vec3 forwardOf(const EyePose& eye) {
  return eye.axes.row[2] * -1;
}

/// Returns what the image may take longer than it is predicted to, if the budget is held.
double roomMs(const HoldDecision& hold) {
  return hold.limitMs > 0 ? hold.limitMs - hold.heldMs.total() : kInfinity;
}

}  // namespace

void OcclusionStage::clear() {
  memory_.clear();
  choice_ = {};
  chosen_ = false;
  serves_.reset();
  hidden_ = hiddenBoxes_ = {};
  visibleKey_.reset();
}

void OcclusionStage::setSubpixelBits(int bits) {
  subpixelBits_ = bits;
  choice_ = {};
  chosen_ = false;
  visibleKey_.reset();
}

void OcclusionStage::plant(const Defects& defects) {
  defects_ = defects;
  visibleKey_.reset();
}

void OcclusionStage::begin(const FrameRequest& request, const EyePose& eye, bool gpuDrawsMaps) {
  serves_.reset();
  hidden_ = hiddenBoxes_ = {};
  chosen_ = false;
  eye_ = eye;
  view_ = request.view;
  refusal_ = ground_.refusal(eye, request.view);
  memory_.beginFrame();
  result_ = {};
  counters_ = {};
  // If counts must not depend on earlier frames, all surfaces are made at once.
  const bool atOnce = request.reproducible || request.waitForPages;
  ground_.share().begin(atOnce ? std::numeric_limits<std::size_t>::max() : SurfaceShare::kAFrame);
  if (const auto resolution = occlusionResolution(request)) {
    resolution_ = *resolution;
    result_.note = refusal_;
    if (refusal_.empty()) serves_ = choose(request);
    if (serves(OcclusionMethod::depth_map) && !gpuDrawsMaps) {
      serves_ = OcclusionMethod::horizon;
      result_.note = kNoGpuMap;
    }
  }
  if (!chosen_) choice_.pause();
  if (serves(OcclusionMethod::horizon)) findHorizon(request);
  result_.occlusion = serves_;
}

/// Chooses between the horizon and nothing by cost, unless the request names a method.
std::optional<OcclusionMethod> OcclusionStage::choose(const FrameRequest& request) {
  static constexpr OcclusionMethod kMethods[] = {OcclusionMethod::horizon};
  if (request.occlusion != OcclusionMethod::automatic) return request.occlusion;
  if (request.reproducible) return OcclusionMethod::horizon;
  const std::uint64_t band = (static_cast<std::uint64_t>(resolution_.widthPx) << 32) |
                             static_cast<std::uint32_t>(resolution_.heightPx);
  chosen_ = true;
  const auto method = choice_.choose({drawingMs_, eye_.position, forwardOf(eye_), ground_.cutNumber().rule,
                                      kMethods, band, roomMs(request.hold)});
  if (!method) {
    ++counters_.occlusionsLeftOut;
    result_.note = kNothingPays;
  }
  return method;
}

void OcclusionStage::findHorizon(const FrameRequest& request) {
  // A frame that must not depend on earlier ones uses no horizon of another eye position.
  const bool alone = request.reproducible && !request.skips.littleHidden;
  const HorizonMemory::Result found =
      memory_.find(ground_, eye_.position,
                   {.columns = HorizonMemory::columnsFor(resolution_.widthPx),
                    .slack = HorizonMemory::slackOf(request.view, subpixelBits_),
                    .raised = defects_.loweringScale < 1,
                    .whole = request.wholeHorizon},
                   request.skips, alone);
  hidden_ = found.hidden;
  hiddenBoxes_ = found.hiddenBoxes;
  counters_.horizonsBuilt = found.built;
  counters_.horizonsMoved = found.moved;
  counters_.horizonsLeftOut = found.leftOut;
  result_.horizon = !hidden_.empty();
  if (!found.noGraph) return;
  result_.note = kNoGraph;
  serves_.reset();
}

bool OcclusionStage::visibleStays(const FrameRequest& request) {
  VisibleKey key{eye_,
                 request.view,
                 request.cullingCase,
                 request.backFaces && eyeIsAboveGround(),
                 farCutM(request),
                 ground_.cutNumber(),
                 serves_,
                 serves_ ? resolution_ : OcclusionResolution{},
                 horizonNumber(),
                 ground_.share().made()};
  // A map on the GPU removes tiles from the visible set, so that set cannot be kept.
  const bool stays = request.skips.sameVisible && !serves(OcclusionMethod::depth_map) && visibleKey_ == key;
  visibleKey_ = key;
  counters_.visibleSelected += !stays;
  return stays;
}

void OcclusionStage::finished(const FrameResult& result) {
  if (result.cost.total > 0 && std::isfinite(result.cost.total)) drawingMs_ += result.cost.total;
  if (!chosen_) return;
  if (ground_.share().missesMany() && ++unlearnt_ < kUnlearntFrames) return;
  unlearnt_ = 0;
  const auto or0 = [](double ms) { return std::isfinite(ms) ? ms : 0; };
  const FrameCost& cost = result.cost;
  OcclusionChoice::Outcome outcome;
  outcome.occlusionMs = or0(cost.occlusion);
  outcome.totalMs = cost.total - or0(cost.page);
  // The GPU works in parallel, and a frame waits for whichever takes longer.
  outcome.drawMs = std::max(outcome.totalMs - outcome.occlusionMs, or0(cost.gpu));
  outcome.totalMs = std::max(outcome.totalMs, or0(cost.gpu));
  outcome.drawn = result.visible.triangles;
  const LevelCut& cut = ground_.cut();
  if (result.visible.occluded > 0 && result.visible.reason.size() == cut.triangles.size())
    for (std::size_t i = 0; i < cut.triangles.size(); ++i)
      if (result.visible.reason[i] == CullReason::occluded) outcome.hidden += cut.triangles[i];
  choice_.learn(outcome);
}

VisibleQuery OcclusionStage::query(const FrameRequest& request) {
  VisibleQuery query{.eye = eye_,
                     .view = request.view,
                     .cull = request.cullingCase != CullingCase::none,
                     .farM = farCutM(request),
                     .hidden = hidden_,
                     .backFaces = request.backFaces && eyeIsAboveGround()};
  if (!defects_.culledNode) return query;
  const std::vector<TileDraw>& tiles = ground_.cut().tiles;
  planted_.assign(tiles.size(), 0);
  std::copy(hidden_.begin(), hidden_.end(), planted_.begin());
  for (std::size_t i = 0; i < tiles.size(); ++i)
    if (tiles[i].node == *defects_.culledNode) planted_[i] = 1;
  query.hidden = planted_;
  return query;
}

DistanceImage OcclusionStage::picture() const {
  if (horizon()) return memory_.picture(eye_, view_, resolution_.widthPx, resolution_.heightPx);
  return {};
}

}  // namespace trimtab::scene
