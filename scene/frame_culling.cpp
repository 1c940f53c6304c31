#include "trimtab/scene/frame_culling.h"

#include <algorithm>
#include <cmath>

#include "trimtab/scene/gl_api.h"
#include "trimtab/scene/tile_cache.h"

namespace trimtab::scene {

void FrameCulling::setDatabase(std::shared_ptr<const terrain::Database> database) {
  database_ = std::move(database);
  cutKey_.reset();
  cut_.tiles.clear();
  ++cutNumber_.cut;
  horizonServed_ = false;
  conditions_.setDatabase(database_);
  horizon_.setDatabase(database_);
}

void FrameCulling::selectCut(const FrameRequest& request, const EyePose& eye, FrameResult& counters) {
  const TerrainIndex& index = database_->index();
  const ViewShape& v = request.view;
  eye_ = eye;
  const CutKey key{eye.position, request.lod.screenSpaceError.value() / defects_.statedErrorScale,
                   request.decision.lodScale,
                   std::max(v.widthPx / (v.right - v.left), v.heightPx / (v.top - v.bottom))};
  if (cutKey_ != key || !request.skips.sameCut) {
    selectLevels(index, key.eye, key.maxErrorPx, key.lodScale, key.pixelsPerRadian, cut_);
    cutNumber_.cut += cutKey_ != key;
    if (cutKey_) cutKey_->eye = key.eye;
    cutNumber_.rule += cutKey_ != key;
    cutKey_ = key;
    ++counters.cutsSelected;
  }
  refusal_ = conditions_.refusal(cut_, eye_, v);
}

void FrameCulling::selectVisible(const FrameRequest& request) {
  const TerrainIndex& index = database_->index();
  trimtab::selectVisible(
      index, cut_, eye_, request.view, request.method != CullingCase::none, visible_,
      request.skips.beyondVisibility ? request.decision.weather.farM : WeatherDecision::kUnlimited, hidden_);
  if (!defects_.culledNode) return;
  flags_.clear();
  for (const TileDraw& tile : visible_.tiles) flags_.push_back(tile.node == defects_.culledNode);
  removeOccluded(index, flags_, visible_);
}

bool FrameCulling::findHidden(const FrameRequest& request, FrameResult& counters) {
  hidden_ = {};
  const auto& size = request.decision.depthMap;
  counters.horizon = request.method == CullingCase::proposed &&
                     request.occlusion != OcclusionMethod::depth_map && size && refusal_.empty();
  horizonServed_ = counters.horizon;
  if (horizonServed_) counters.occlusion = OcclusionMethod::horizon;
  if (!counters.horizon) return false;
  const std::uint64_t built = horizon_.built(), leftOut = horizon_.leftOut();
  hidden_ =
      horizon_.hidden(cut_, cutNumber_, eye_.position,
                      {HorizonCulling::columnsFor(size->widthPx),
                       HorizonCulling::slackOf(request.view, subpixelBits_), defects_.loweringScale < 1},
                      conditions_, request.skips);
  counters.horizonsBuilt += horizon_.built() - built;
  counters.horizonsLeftOut += horizon_.leftOut() - leftOut;
  view_ = request.view;
  mapSize_ = *size;
  return true;
}

std::optional<DepthView> FrameCulling::prepareOcclusion(const FrameRequest& request, const TileCache& tiles,
                                                        OcclusionPass& pass, FrameResult& counters) {
  counters.depthMap.reset();
  counters.note.clear();
  depthMapCurrent_ = false;
  const auto& size = request.decision.depthMap;
  if (request.method != CullingCase::proposed || !size || visible_.tiles.empty()) return {};
  counters.note = refusal_;
  if (!refusal_.empty() || request.occlusion != OcclusionMethod::depth_map) return {};
  testedSlots_.clear();
  occluders_.clear();
  // Far tiles cost as much to draw as near ones and hide little: measured over Everest and Fuji, leaving out
  // what is narrower than 48 texels costs a few percent of the hidden tiles and saves up to half of the pass.
  const TerrainIndex& index = database_->index();
  const double texelsPerTangent = size->widthPx / (request.view.right - request.view.left);
  const double leastTexels = std::min(48.0, 0.12 * size->widthPx);
  const auto texelsAcross = [&](const Box& b) {
    const Vec3 middle{0.5 * (double{b.minX} + b.maxX), 0.5 * (double{b.minY} + b.maxY),
                      0.5 * (double{b.minZ} + b.maxZ)};
    return (double{b.maxX} - b.minX) * texelsPerTangent / length(middle - eye_.position);
  };
  for (const TileDraw& tile : visible_.tiles) {
    testedSlots_.push_back(tiles.slotOf(tile.node));
    if (conditions_.mayOcclude(tile.node) && texelsAcross(index.bounds[tile.node]) >= leastTexels)
      occluders_.push_back(tile);
  }
  if (occluders_.empty()) {
    counters.note = "no tile in view may hide another: too far, or at the terrain's edge";
    return {};
  }
  pass.prepare(size->widthPx, size->heightPx, testedSlots_);
  counters.depthMap = size;
  counters.occlusion = OcclusionMethod::depth_map;
  ++counters.depthMapsDrawn;
  depthMapCurrent_ = true;
  nearM_ = request.view.nearM;
  return DepthView{eye_,
                   size->widthPx,
                   size->heightPx,
                   OcclusionPass::kLevels,
                   static_cast<int>(testedSlots_.size()),
                   defects_.loweringScale,
                   defects_.depthMapShiftTexels};
}

void FrameCulling::removeHidden(const TileCache& tiles, OcclusionPass& pass) {
  pass.test(tiles, flags_);
  removeOccluded(database_->index(), flags_, visible_);
}

Renderer::Grey FrameCulling::readDepthMap(const OcclusionPass& pass) const {
  if (horizonServed_) return horizon_.picture(eye_, view_, mapSize_.widthPx, mapSize_.heightPx);
  if (!depthMapCurrent_) return {};
  std::vector<float> depths;
  GLint before = 0;
  glGetIntegerv(GL_READ_FRAMEBUFFER_BINDING, &before);
  pass.read(depths);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, static_cast<GLuint>(before));
  return greyOf(depths, pass.width(), pass.height(), nearM_);
}

Renderer::Grey greyOf(std::span<const float> depths, int width, int height, double nearM) {
  Renderer::Grey grey{width, height, std::vector<std::uint8_t>(depths.size(), 255)};
  // By the logarithm of the distance: the same step is the same ratio near and far.
  constexpr double kFrom = Renderer::Grey::kNearestM, kTo = Renderer::Grey::kFurthestM;
  for (std::size_t i = 0; i < depths.size(); ++i) {
    if (!(depths[i] > 0)) continue;
    const double distance = std::clamp(nearM / double{depths[i]}, kFrom, kTo);
    grey.pixels[i] =
        static_cast<std::uint8_t>(std::lround(254 * std::log(distance / kFrom) / std::log(kTo / kFrom)));
  }
  return grey;
}

}  // namespace trimtab::scene
