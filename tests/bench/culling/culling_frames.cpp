#include "culling_frames.h"

#include <cmath>
#include <numeric>
#include <random>
#include <string>

#include "culling_floor.h"
#include "culling_lod.h"
#include "culling_queries.h"
#include "tests/core/scene/scene_test.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/measure/paired_ratio.h"
#include "trimtab/scene/renderer.h"
#include "trimtab/terrain/bake/cache.h"
#include "trimtab/terrain/synthetic/sample.h"

namespace trimtab::bench {
namespace {

class Frames {
 public:
  explicit Frames(std::shared_ptr<const terrain::Database> database) : database_(std::move(database)) {
    auto created = scene::Offscreen::create(1280, 720);
    if (!created) return;
    offscreen_ = std::move(created).value();
    ready_ = renderer_.initialize().usable;
    renderer_.setTerrain(database_);
  }
  ~Frames() {
    if (offscreen_) renderer_.release();
  }
  bool ready() const { return ready_; }

  /// Frame times of *proposed* over *view frustum* at `feet` above the ground, in pairs along short flights:
  /// a frame's way apart at 600 kt, or a centimetre.
  struct Flight {
    double feet = 2000;
    double errorPx = 2;
    OcclusionMethod method = OcclusionMethod::automatic;
    bool hovers = false;
    double pitch = -5;
  };
  void row(Report& report, const std::string& terrain, const Flight& flight) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> place(0.25, 0.75), heading(0, 360);
    std::vector<double> frustum, proposed, occlusion;
    double frustumMs = 0, proposedMs = 0;  // means of the flights' medians
    std::size_t hidden = 0, inView = 0, looked = 0;
    const int views = report.quick() ? 3 : 6, warmUp = report.quick() ? 8 : 20;
    // Short frames are as uncertain as long ones in milliseconds: of them there are more.
    const double msAFlight = report.quick() ? 700 : 2000;
    const int leastPairs = report.quick() ? 8 : 24, mostPairs = 100;
    // What another row has learnt, and owes to trials, is forgotten.
    offscreen_->makeCurrent();
    renderer_.setTerrain(database_);
    for (int view = 0; view < views; ++view) {
      FrameRequest r;
      const double east = place(random), north = place(random), course = heading(random);
      r.eye = placeOver(*database_, east, north, flight.feet * kMetresAFoot);
      r.attitude = {Degrees{course}, Degrees{flight.pitch}, Degrees{0}};
      r.view.widthPx = 1280, r.view.heightPx = 720;
      r.occlusion = flight.method;
      r.waitForPages = true;
      r.levers.drawn.errorPx = flight.errorPx;
      // The band of level flight below 4,000 ft, and above 8,000 ft.
      r.levers.drawn.occlusion =
          flight.feet < 4000 ? OcclusionResolution{800, 600} : OcclusionResolution{320, 240};
      int pairs = leastPairs;
      double warmMs = 0;
      for (int i = -warmUp; i < pairs; ++i) {
        moveOn(r.eye, course, flight.hovers);
        FrameResult plain, ours;
        // Each comes first as often: the first frame at a place is not like the second.
        for (const bool proposing : {i % 2 != 0, i % 2 == 0}) {
          r.cullingCase = proposing ? CullingCase::proposed : CullingCase::view_frustum;
          draw(r);
          (proposing ? ours : plain) = last_;
        }
        if (i < 0) {
          warmMs += (plain.cost.total + ours.cost.total) / warmUp;
          pairs = std::clamp(static_cast<int>(msAFlight / warmMs), leastPairs, mostPairs);
          continue;
        }
        occlusion.push_back(std::isfinite(ours.cost.occlusion) ? ours.cost.occlusion : 0);
        frustum.push_back(plain.cost.total);
        proposed.push_back(ours.cost.total);
        hidden += ours.visible.occluded;
        inView += ours.visible.occluded + ours.visible.tiles.size();
        looked += ours.occlusion.has_value();
      }
      frustumMs += median({frustum.end() - pairs, frustum.end()}) / views;
      proposedMs += median({proposed.end() - pairs, proposed.end()}) / views;
    }
    const PairedRatio ratio = pairedRatio(frustum, proposed);
    const std::string id = "culling.frame_" + terrain + "_" + std::to_string(static_cast<int>(flight.feet)) +
                           "ft" + (flight.errorPx < 1 ? "_finest" : "") + (flight.hovers ? "_hover" : "") +
                           suffixOf(flight.method);
    char share[280];
    std::snprintf(
        share, sizeof share,
        "; of %zu tiles in view %.0f %% left out, looked for in %.0f %% of the frames, %.2f ms a frame; "
        "ratio of pairs: median %.3f, 95 %% interval %.3f to %.3f; %zu pairs, and %d a flight to warm up",
        inView / proposed.size(), 100.0 * static_cast<double>(hidden) / static_cast<double>(inView),
        100.0 * static_cast<double>(looked) / static_cast<double>(proposed.size()), mean(occlusion),
        ratio.median, ratio.low, ratio.high, ratio.pairs, warmUp);
    const Row row{.id = id,
                  .what = "Frame of proposed, mean over " + terrain + share,
                  .value = proposedMs,
                  .unit = "ms",
                  .peer = "view frustum",
                  .peerValue = frustumMs,
                  .peerFrom = "run",
                  .ratio = ratio.median};
    const bool mountains = terrain == "mountains" || terrain == "everest";
    if (mountains && flight.feet == 2000) return report.add(ratioAtMost(1.0 / 3, row));
    if (flight.method != OcclusionMethod::automatic) return report.add(row);
    Row bound = row;
    bound.ratio = ratio.high;
    report.add(ratioAtMost(1.02, bound));
  }

  /// What *proposed* takes of the processor to choose what to draw, levels, view and hidden ground, of the
  /// frames of a flight; none of them is the first of its kind.
  void stageRow(Report& report, OcclusionMethod method) {
    FrameRequest r;
    constexpr double kCourse = 30;
    r.eye = placeOver(*database_, 0.45, 0.35, 2000 * kMetresAFoot);
    r.attitude = {Degrees{kCourse}, Degrees{-5}, Degrees{0}};
    r.view.widthPx = 1280, r.view.heightPx = 720;
    r.occlusion = method;
    r.waitForPages = true;
    r.levers.drawn.errorPx = 0.05;
    r.levers.drawn.occlusion = OcclusionResolution{800, 600};
    const int frames = report.quick() ? 8 : 24, warmUp = 8;
    std::vector<double> stage, total;
    std::size_t cut = 0, looked = 0;
    for (int i = -warmUp; i < frames; ++i) {
      moveOn(r.eye, kCourse, false);
      draw(r);
      if (i < 0) continue;
      const FrameCost& cost = last_.cost;
      stage.push_back(cost.select + (std::isfinite(cost.occlusion) ? cost.occlusion : 0));
      total.push_back(cost.total);
      cut += last_.tilesInCut;
      looked += last_.occlusion.has_value();
    }
    std::vector<double> shares;
    for (std::size_t i = 0; i < stage.size(); ++i) shares.push_back(stage[i] / total[i]);
    char what[200];
    std::snprintf(what, sizeof what,
                  "Levels, view and hidden ground of %zu tiles at 600 kt, median of %d frames; hidden ground "
                  "looked for in %.0f %% of them",
                  cut / stage.size(), frames,
                  100.0 * static_cast<double>(looked) / static_cast<double>(stage.size()));
    const Row row{.id = "culling.stage" + suffixOf(method),
                  .what = what,
                  .value = median(stage),
                  .unit = "ms",
                  .peer = "the whole frame at 1280x720",
                  .peerValue = median(total),
                  .peerFrom = "run",
                  .ratio = median(shares)};
    report.add(method == OcclusionMethod::automatic ? ratioAtMost(0.02, row) : row);
  }

 private:
  static double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
  }
  static double mean(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  }
  static std::string suffixOf(OcclusionMethod method) {
    switch (method) {
      case OcclusionMethod::automatic:
        return {};
      case OcclusionMethod::depth_map:
        return "_depth_map";
      case OcclusionMethod::horizon:
        return "_horizon";
    }
    return {};
  }
  static void moveOn(GeodeticPosition& eye, double course, bool hovers) {
    if (hovers) {
      eye.height = eye.height + Metres{0.01};
      return;
    }
    constexpr double kStepM = 600 * 0.514444 / 60, kMetresADegree = 111e3, kDegree = 0.017453292519943295;
    const double step = kStepM / kMetresADegree;
    eye.latitude = eye.latitude + Degrees{step * std::cos(course * kDegree)};
    eye.longitude =
        eye.longitude + Degrees{step * std::sin(course * kDegree) / std::cos(eye.latitude.value() * kDegree)};
  }
  double draw(const FrameRequest& r) {
    offscreen_->makeCurrent();
    last_ = renderer_.draw(r, offscreen_->framebuffer());
    return last_.cost.total;
  }

  std::shared_ptr<const terrain::Database> database_;
  std::unique_ptr<scene::Offscreen> offscreen_;
  scene::Renderer renderer_;
  FrameResult last_;
  bool ready_ = false;
};

void rowsOf(Report& report, const std::string& name,
            const std::shared_ptr<const terrain::Database>& database) {
  Frames frames(database);
  if (!frames.ready()) return;
  for (const double feet : {300.0, 2000.0, 8000.0, 30000.0})
    frames.row(report, name, {.feet = feet, .pitch = feet > 10000 ? -30.0 : -5.0});
  frames.row(report, name, {.feet = 2000, .hovers = true});
  if (name == "sea") return;
  frames.row(report, name, {.feet = 2000, .errorPx = 0.05});
  if (name != "mountains" && name != "everest") return;
  for (const OcclusionMethod method : {OcclusionMethod::horizon, OcclusionMethod::depth_map})
    frames.row(report, name, {.feet = 2000, .method = method});
}

void peerRowsOf(Report& report, const std::string& name,
                const std::shared_ptr<const terrain::Database>& database) {
  queryRows(report, name, database);
  lodRows(report, name, database);
}

}  // namespace

GeodeticPosition placeOver(const terrain::Database& database, double east, double north, double aboveM) {
  GeodeticPosition place = scene::placeIn(database.info(), east, north);
  place.height = database.heightAt(place.latitude, place.longitude).value_or(Metres{0}) + Metres{aboveM};
  return place;
}

void frameRows(Report& report) {
  const auto mountainRows = [&](const std::string& name, const auto& databaseOf) {
    const bool frames = report.wants("frame_" + name), floor = report.wants("floor_" + name);
    if (!frames && !floor) return;
    const std::shared_ptr<const terrain::Database> database = databaseOf();
    if (!database) return;
    if (frames) rowsOf(report, name, database);
    if (floor) floorRows(report, name, database);
    if (frames) peerRowsOf(report, name, database);
  };
  mountainRows("mountains", [] { return test::syntheticMountains(); });
  const auto flat = [](double relief) {
    return std::make_shared<const test::SyntheticTerrain>(
        16, 1.0 / 1200, GeodeticPosition{Degrees{36.4}, Degrees{128.1}, Metres{0}},
        [relief](int column, int row) { return relief * std::sin(column * 0.1) * std::cos(row * 0.13); });
  };
  if (report.wants("frame_sea")) rowsOf(report, "sea", flat(0));
  if (report.wants("frame_plain")) rowsOf(report, "plain", flat(5));
  const test::ScratchDir dir;
  const auto shared = [&](const char* folder) -> std::shared_ptr<const terrain::Database> {
    const auto source = test::sharedDir() / "data" / folder;
    if (!std::filesystem::exists(source)) return nullptr;
    const auto baked = terrain::openOrBake(source, dir / "cache", {});
    return baked ? baked.value() : nullptr;
  };
  mountainRows("everest", [&] { return shared("dem-srtm3-everest"); });
  if (report.wants("frame_iceland"))
    if (const auto iceland = shared("fg-debian-iceland-reykjanes")) rowsOf(report, "iceland", iceland);
  if (!report.wants("frame_sample")) return;
  terrain::SampleOptions options;
  options.postM = report.quick() ? 180 : 90;
  if (!terrain::writeSample(dir / "sample.tif", options)) return;
  if (const auto baked = terrain::openOrBake(dir / "sample.tif", dir / "cache", {}))
    rowsOf(report, "sample", baked.value());
}

void stageRows(Report& report) {
  const test::ScratchDir dir;
  terrain::SampleOptions options;
  options.postM = 50;
  options.sizeKm = 102.4;
  if (!terrain::writeSample(dir / "stage.tif", options)) return;
  const auto baked = terrain::openOrBake(dir / "stage.tif", dir / "cache", {});
  if (!baked) return;
  Frames frames(baked.value());
  if (!frames.ready()) return;
  for (const OcclusionMethod method : {OcclusionMethod::automatic, OcclusionMethod::horizon})
    frames.stageRow(report, method);
}

}  // namespace trimtab::bench
