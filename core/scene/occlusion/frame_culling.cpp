#include "frame_culling.h"

#include <algorithm>
#include <cmath>

#include "core/scene/gl/gl_api.h"
#include "core/scene/terrain/tiles/tile_cache.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/scene/planted_defects.h"

namespace trimtab::scene {

void FrameCulling::setDatabase(std::shared_ptr<const terrain::Database> database) {
  database_ = std::move(database);
  cutKey_.reset();
  cut_.tiles.clear();
  ++cutNumber_.cut;
  ground_.setDatabase(database_);
  ground_.setCut(cut_, cutNumber_);
  occlusion_.clear();
  depthMapCurrent_ = false;
}

void FrameCulling::plant(const Defects& defects) {
  defects_ = defects;
  occlusion_.plant(defects);
}

void FrameCulling::selectCut(const FrameRequest& request, const EyePose& eye) {
  const TerrainIndex& index = database_->index();
  eye_ = eye;
  cutSelected_ = false;
  const CutKey key{eye.position, request.lod.screenSpaceError.value() / defects_.statedErrorScale,
                   request.decision.lodScale, pixelsPerRadian(request.view)};
  if (cutKey_ == key && request.skips.sameCut) return;
  selectLevels(index, key.eye, key.maxErrorPx, key.lodScale, key.pixelsPerRadian, cut_);
  cutNumber_.errorOverDistance = key.maxErrorPx * key.lodScale / key.pixelsPerRadian;
  cutNumber_.cut += cutKey_ != key;
  if (cutKey_) cutKey_->eye = key.eye;
  cutNumber_.rule += cutKey_ != key;
  cutKey_ = key;
  cutSelected_ = true;
}

void FrameCulling::beginOcclusion(const FrameRequest& request) {
  occlusion_.begin(request, eye_, true);
}

bool FrameCulling::selectVisible(const FrameRequest& request) {
  if (occlusion_.visibleStays(request)) return false;
  const TerrainIndex& index = database_->index();
  trimtab::selectVisible(index, cut_, eye_, request.view, request.method != CullingCase::none, visible_,
                         farCutM(request), occlusion_.hidden(),
                         request.backFaces && occlusion_.eyeIsAboveGround());
  if (!defects_.culledNode) return true;
  flags_.clear();
  for (const TileDraw& tile : visible_.tiles) flags_.push_back(tile.node == defects_.culledNode);
  removeOccluded(index, flags_, visible_);
  return true;
}

void FrameCulling::removeHiddenByMap(const FrameRequest& request) {
  if (const auto flags = occlusion_.hiddenByMap(request, visible_); !flags.empty())
    removeOccluded(database_->index(), flags, visible_);
}

std::optional<DepthView> FrameCulling::prepareOcclusion(const FrameRequest& request, const TileCache& tiles,
                                                        OcclusionPass& pass) {
  depthMapCurrent_ = false;
  mapNote_.clear();
  if (!occlusion_.serves(OcclusionMethod::depth_map) || visible_.tiles.empty()) return {};
  const DepthMapSize size = occlusion_.resolution();
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
    testedSlots_.push_back(tiles.slotOf(tile.node));
    if (ground_.conditions().mayOcclude(tile.node) && texelsAcross(index.bounds[tile.node]) >= leastTexels)
      occluders_.push_back(tile);
  }
  if (occluders_.empty()) {
    mapNote_ = "No tile in view may hide another: all are too far away or at the terrain's edge.";
    return {};
  }
  pass.prepare(size.widthPx, size.heightPx, testedSlots_);
  depthMapCurrent_ = true;
  nearM_ = request.view.nearM;
  return DepthView{eye_,
                   size.widthPx,
                   size.heightPx,
                   OcclusionPass::kLevels,
                   static_cast<int>(testedSlots_.size()),
                   defects_.loweringScale,
                   defects_.depthMapShiftTexels};
}

OcclusionResult FrameCulling::result() const {
  OcclusionResult result = occlusion_.result();
  if (!mapNote_.empty()) result.note = mapNote_;
  if (depthMapCurrent_) result.depthMap = occlusion_.resolution();
  return result;
}

FrameCounters FrameCulling::counters() const {
  FrameCounters counters = occlusion_.counters();
  counters.cutsSelected += cutSelected_;
  counters.depthMapsDrawn += depthMapCurrent_;
  return counters;
}

void FrameCulling::removeHidden(const TileCache& tiles, OcclusionPass& pass) {
  pass.test(tiles, flags_);
  removeOccluded(database_->index(), flags_, visible_);
}

Renderer::Grey FrameCulling::readDepthMap(const OcclusionPass& pass) const {
  if (!depthMapCurrent_) return occlusion_.picture();
  std::vector<float> depths;
  GLint before = 0;
  glGetIntegerv(GL_READ_FRAMEBUFFER_BINDING, &before);
  pass.read(depths);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, static_cast<GLuint>(before));
  return greyOf(depths, pass.width(), pass.height(), nearM_);
}

Renderer::Grey greyOf(std::span<const float> depths, int width, int height, double nearM) {
  Renderer::Grey grey{width, height, std::vector<std::uint8_t>(depths.size(), 255)};
  // The grey follows the logarithm of the distance, so that a step is the same ratio near and far.
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
