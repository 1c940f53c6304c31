#include "stage.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "trimtab/hold/cost_model_file.h"
#include "trimtab/scene/data_extent.h"
#include "trimtab/terrain/format/database.h"
#include "trimtab/terrain/grid/progress.h"

namespace trimtab::experiment {

Result<std::unique_ptr<Stage>> Stage::open(const Setup& setup) {
  auto offscreen = scene::Offscreen::create(setup.widthPx, setup.heightPx);
  if (!offscreen) return offscreen.findings();
  std::unique_ptr<Stage> stage(new Stage);
  stage->offscreen_ = std::move(offscreen).value();
  stage->offscreen_->makeCurrent();
  stage->width_ = setup.widthPx;
  stage->height_ = setup.heightPx;
  stage->gl_ = stage->renderer_.initialize();
  if (!stage->gl_.usable)
    return Finding{Severity::error, "OpenGL", {}, "what the renderer needs", stage->gl_.missing};
  stage->renderer_.setTerrain(setup.terrain);
  return {std::move(stage)};
}

Stage::~Stage() {
  offscreen_->makeCurrent();
  renderer_.release();
}

FrameResult Stage::drawAndWait(FrameRequest request) {
  offscreen_->makeCurrent();
  if (request.view.widthPx != width_ || request.view.heightPx != height_) {
    width_ = request.view.widthPx;
    height_ = request.view.heightPx;
    offscreen_->resize(width_, height_);
  }
  request.waitForImage = true;
  return renderer_.draw(request, offscreen_->framebuffer());
}

FrameResult Stage::draw(const FrameRequest& request) {
  FrameRequest alone = request;
  alone.waitForPages = alone.reproducible = true;
  return drawAndWait(std::move(alone));
}

FrameResult Stage::fly(const FrameRequest& request) {
  return drawAndWait(request);
}

scene::BuiltAhead Stage::buildAhead(std::span<const std::uint32_t> nodes, double withinMs) {
  offscreen_->makeCurrent();
  return renderer_.buildAhead(nodes, withinMs);
}

void Stage::setTerrain(std::shared_ptr<const terrain::Database> terrain) {
  offscreen_->makeCurrent();
  renderer_.setTerrain(std::move(terrain));
}

double Stage::medianMs(const FrameRequest& request, int repeats, FrameResult& last) {
  draw(request);
  std::vector<double> ms;
  for (int i = 0; i < std::max(repeats, 1); ++i) {
    last = draw(request);
    ms.push_back(last.cost.total);
  }
  return quantileOf(ms, 0.5);
}

std::vector<std::uint8_t> Stage::pixels(const FrameRequest& request) {
  draw(request);
  return shown();
}

scene::CutError Stage::cutError(const FrameRequest& request) {
  offscreen_->makeCurrent();
  return scene::cutError(renderer_, request, offscreen_->framebuffer());
}

std::vector<std::uint8_t> Stage::shown() {
  offscreen_->makeCurrent();
  return renderer_.readPixels(width_, height_);
}

std::vector<float> Stage::distances() {
  offscreen_->makeCurrent();
  return renderer_.readDistances();
}

std::string Stage::machine() const {
  return machineName(gl_.renderer);
}

std::vector<Place> placesOf(const Setup& setup, std::size_t count) {
  std::vector<Place> places;
  const auto add = [&](Degrees latitude, Degrees longitude, const Attitude& attitude) {
    const auto ground = setup.terrain->highestWithin(latitude, longitude, Metres{2000});
    if (ground) places.push_back({{latitude, longitude, *ground}, attitude});
  };
  if (setup.flight && !setup.flight->states.empty()) {
    for (std::size_t i = 0; i < count; ++i) {
      const double part = (static_cast<double>(i) + 0.5) / static_cast<double>(count);
      const AircraftState state =
          stateAt(*setup.flight, setup.flight->beginS() + part * setup.flight->durationS());
      add(state.position.latitude, state.position.longitude, {state.attitude.heading, {}, {}});
    }
    return places;
  }
  const terrain::TerrainInfo& info = setup.terrain->info();
  constexpr double kAt[5][2] = {{0.5, 0.5}, {0.3, 0.3}, {0.3, 0.7}, {0.7, 0.3}, {0.7, 0.7}};
  for (const auto& at : kAt)
    for (const double heading : {0.0, 90.0, 180.0, 270.0})
      if (places.size() < count) {
        const GeodeticPosition place = scene::placeIn(info, at[1], at[0]);
        add(place.latitude, place.longitude, {Degrees{heading}, {}, {}});
      }
  return places;
}

std::size_t differingPixels(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
  std::size_t differing = 0;
  for (std::size_t i = 0; i + 3 < a.size() && i + 3 < b.size(); i += 4)
    differing += a[i] != b[i] || a[i + 1] != b[i + 1] || a[i + 2] != b[i + 2];
  return a.size() == b.size() ? differing : std::max(a.size(), b.size()) / 4;
}

double meanOf(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return values.empty() ? std::numeric_limits<double>::quiet_NaN() : sum / static_cast<double>(values.size());
}

Finding notOverTerrain(const Setup& setup) {
  return {Severity::error, setup.terrainName, {}, "a flight over the terrain", "no place lies over it"};
}

Finding cancelled() {
  return {Severity::error, "experiment", {}, "to run to its end", "it was cancelled"};
}

}  // namespace trimtab::experiment
