#include "horizon_memory.h"
#include "trimtab/frame/frame_request.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace trimtab::scene {

std::vector<float> elevationsOf(const Horizon& horizon, int samples) {
  std::vector<float> elevations;
  constexpr double kDegrees = 180 / std::numbers::pi;
  for (int i = 0; i < samples; ++i) {
    // Clockwise from south.
    const double turned = 2 * std::numbers::pi * (i + 0.5) / samples;
    const auto elevation = horizon.elevation(-std::sin(turned), -std::cos(turned));
    elevations.push_back(elevation ? static_cast<float>(*elevation * kDegrees)
                                   : std::numeric_limits<float>::quiet_NaN());
  }
  return elevations;
}

void OcclusionGround::setObjects(const ObjectIndex* objects) {
  boxes_.clear();
  reliefs_ = objects ? reliefsOfCells(*objects) : std::vector<Relief>{};
  for (const Relief& relief : reliefs_) boxes_.push_back({.box = &relief});
}

int HorizonMemory::columnsFor(int resolutionWidthPx) {
  return std::clamp(2 * resolutionWidthPx, Horizon::kLeastColumns, Horizon::kMostColumns);
}

double HorizonMemory::slackOf(const ViewShape& view, int subpixelBits) {
  // Five steps of a rasteriser with 256 steps per pixel, which includes a margin for rounding; as many of
  // coarser steps.
  const double pixels = 0.02 * std::max(1.0, std::ldexp(1.0, 8 - subpixelBits));
  return pixels * std::max((view.right - view.left) / view.widthPx, (view.top - view.bottom) / view.heightPx);
}

DistanceImage HorizonMemory::picture(const EyePose& eye, const ViewShape& view, int widthPx,
                                     int heightPx) const {
  constexpr std::uint8_t kCovered = 110, kOpen = 255;
  DistanceImage grey{widthPx, heightPx, {}};
  grey.pixels.reserve(static_cast<std::size_t>(widthPx) * static_cast<std::size_t>(heightPx));
  const Mat3 toLocal = transposed(eye.axes);
  for (int y = 0; y < heightPx; ++y)
    for (int x = 0; x < widthPx; ++x) {
      const double across = view.left + (view.right - view.left) * (x + 0.5) / widthPx,
                   up = view.bottom + (view.top - view.bottom) * (y + 0.5) / heightPx;
      grey.pixels.push_back(horizon().blocks(toLocal * Vec3{across, up, -1}) ? kCovered : kOpen);
    }
  return grey;
}

void HorizonMemory::clear() {
  moving_.clear();
  key_.reset();
  boxesHidLittleAt_.reset();
}

/// Returns true if the last horizon hid next to nothing and was built near here.
bool HorizonMemory::hidLittleNear(const Key& key) const {
  return key_ && hidLittle_ && key_->cut.rule == key.cut.rule &&
         key_->settings.columns == key.settings.columns && key_->settings.raised == key.settings.raised &&
         length(key.eye - key_->eye) < kBelievedM;
}

HorizonMemory::Result HorizonMemory::find(OcclusionGround& ground, Vec3 eye,
                                          const Horizon::Settings& settings, const Skips& skips, bool alone) {
  const Key key{eye, ground.cutNumber(), settings};
  const bool samePlace = key_ == key;
  if (!samePlace && skips.littleHidden && hidLittleNear(key))
    return {.hidden = {}, .hiddenBoxes = {}, .leftOut = true};
  const std::size_t missing = ground.makeSurfaces(eye), nodes = ground.cut().tiles.size();
  if (!ground.isGraph()) {
    if (missing == 0) {
      clear();
      ground.forgetOthers();
    }
    return {.hidden = {}, .hiddenBoxes = {}, .noGraph = true};
  }
  // Surfaces made since the last horizon enter the next one, and an eye that moves begins one soon. For an
  // eye at rest one is built when twice as many surfaces are there, or half as many are missing, or none is.
  const bool muchMore =
      2 * missing <= missingThen_ || nodes - missing >= 2 * (nodes - std::min(missingThen_, nodes));
  const bool grown = missing < missingThen_ &&
                     ((samePlace && missing == 0) || (SurfaceShare::isMany(missingThen_, nodes) && muchMore));
  if (grown) moving_.restart();
  MovingHorizon::Frame frame;
  frame.eye = eye;
  frame.framesSince = static_cast<double>(frame_ - std::exchange(lastFrame_, frame_));
  frame.cut = key.cut.cut;
  frame.rule = key.cut.rule;
  frame.tiles = ground.cut().tiles;
  const bool fewBoxes = !alone && skips.littleHidden && boxesHidLittleAt_ &&
                        length(eye - *boxesHidLittleAt_) < kBelievedM;
  if (!fewBoxes) frame.boxes = ground.boxes();
  frame.errorOverDistance = key.cut.errorOverDistance;
  frame.settings = settings;
  frame.sameHorizon = skips.sameHorizon;
  frame.incremental = !alone;
  frame.mayOcclude = [&ground](std::uint32_t node) { return ground.mayOcclude(node); };
  frame.replacementsStayNear = [&ground](std::uint32_t node) { return ground.replacementsStayNear(node); };
  const std::uint64_t scratch = moving_.fromScratch(), built = moving_.built();
  const Horizon* const before = &horizon();
  const auto hidden = moving_.hidden(frame, ground.tree(), [&](std::vector<HorizonTile>& tiles) {
    missingThen_ = missing;
    ground.fill(tiles);
  });
  const bool atOnce = moving_.fromScratch() != scratch;
  number_ += atOnce || before != &horizon();
  if (!samePlace || grown) {
    const auto isLittleOf = [](std::span<const std::uint8_t> flags) {
      const auto count = std::count(flags.begin(), flags.end(), std::uint8_t{1});
      return flags.empty() || isLittle(static_cast<std::size_t>(count), flags.size());
    };
    const bool boxesToo = isLittleOf(moving_.hiddenBoxes());
    hidLittle_ = isLittleOf(hidden) && boxesToo && !SurfaceShare::isMany(missingThen_, nodes);
    if (!boxesToo)
      boxesHidLittleAt_.reset();
    else if (!moving_.hiddenBoxes().empty())
      boxesHidLittleAt_ = eye;
  }
  key_ = key;
  return {.hidden = hidden,
          .hiddenBoxes = moving_.hiddenBoxes(),
          .moved = !samePlace && !atOnce,
          .built = moving_.built() - built};
}

}  // namespace trimtab::scene
