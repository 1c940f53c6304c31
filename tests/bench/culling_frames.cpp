#include "culling_frames.h"

#include <random>
#include <string>

#include "culling_lod.h"
#include "culling_queries.h"
#include "scene/scene_test.h"
#include "trimtab/measure/paired_ratio.h"

namespace trimtab::bench {
namespace {

constexpr double kMetresAFoot = 0.3048;

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

  /// Frame times of *proposed* over *view frustum* at `feet` above the ground, in pairs.
  void row(Report& report, const std::string& terrain, double feet, double errorPx, OcclusionMethod method) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> place(0.25, 0.75), heading(0, 360);
    std::vector<double> frustum, proposed, occlusion;
    double frustumMs = 0, proposedMs = 0;  // means of the views' medians
    std::size_t hidden = 0, inView = 0;
    const int views = report.quick() ? 3 : 8, repeats = 5;
    for (int view = 0; view < views; ++view) {
      scene::FrameRequest r;
      const double east = place(random), north = place(random);
      r.eye = placeOver(*database_, east, north, feet * kMetresAFoot);
      r.attitude = {Degrees{heading(random)}, Degrees{-5}, Degrees{0}};
      r.view.widthPx = 1280, r.view.heightPx = 720;
      r.occlusion = method;
      r.lod.screenSpaceError = Pixels{errorPx};
      // The band of level flight below 4,000 ft, and above 8,000 ft.
      r.decision.depthMap = feet < 4000 ? DepthMapSize{800, 600} : DepthMapSize{320, 240};
      for (int i = -1; i < repeats; ++i) {
        // A head that moves on: nothing is the same as in the frame before.
        r.eye.height = r.eye.height + Metres{0.01};
        r.method = CullingCase::view_frustum;
        const double first = draw(r);
        r.method = CullingCase::proposed;
        const double second = draw(r);
        if (i < 0) continue;
        occlusion.push_back(last_.cost.occlusion);
        frustum.push_back(first);
        proposed.push_back(second);
        hidden += last_.visible.occluded;
        inView += last_.visible.occluded + last_.visible.tiles.size();
      }
      frustumMs += median({frustum.end() - repeats, frustum.end()}) / views;
      proposedMs += median({proposed.end() - repeats, proposed.end()}) / views;
    }
    const PairedRatio ratio = pairedRatio(frustum, proposed);
    const std::string id = "culling.frame_" + terrain + "_" + std::to_string(static_cast<int>(feet)) + "ft" +
                           (errorPx < 1 ? "_finest" : "") +
                           (method == OcclusionMethod::depth_map ? "_depth_map" : "");
    char share[200];
    std::snprintf(share, sizeof share,
                  "; of %zu tiles in view %.0f %% left out for %.2f ms; ratio of pairs: median %.3f, 95 %% "
                  "interval %.3f to %.3f",
                  inView / proposed.size(), 100.0 * static_cast<double>(hidden) / static_cast<double>(inView),
                  median(occlusion), ratio.median, ratio.low, ratio.high);
    const Row row{.id = id,
                  .what = std::string("Frame of proposed (") +
                          (method == OcclusionMethod::horizon ? "horizon" : "depth map") + "), mean over " +
                          terrain + share,
                  .value = proposedMs,
                  .unit = "ms",
                  .peer = "view frustum",
                  .peerValue = frustumMs,
                  .peerFrom = "run",
                  .ratio = ratio.median};
    if (terrain == "everest" && feet == 2000) return report.add(ratioAtMost(1.0 / 3, row));
    Row bound = row;
    bound.ratio = ratio.high;
    report.add(ratioAtMost(1.02, bound));
  }

 private:
  static double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
  }
  double draw(const scene::FrameRequest& r) {
    offscreen_->makeCurrent();
    last_ = renderer_.draw(r, offscreen_->framebuffer());
    return last_.cost.total;
  }

  std::shared_ptr<const terrain::Database> database_;
  std::unique_ptr<scene::Offscreen> offscreen_;
  scene::Renderer renderer_;
  scene::FrameResult last_;
  bool ready_ = false;
};

void rowsOf(Report& report, const std::string& name, std::shared_ptr<const terrain::Database> database) {
  Frames frames(std::move(database));
  if (!frames.ready()) return;
  for (const double feet : {300.0, 2000.0, 8000.0})
    frames.row(report, name, feet, 2, OcclusionMethod::horizon);
  frames.row(report, name, 2000, 0.05, OcclusionMethod::horizon);
  for (const double feet : {300.0, 2000.0, 8000.0})
    frames.row(report, name, feet, 2, OcclusionMethod::depth_map);
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
  const auto mountains = test::syntheticMountains();
  rowsOf(report, "mountains", mountains);
  peerRowsOf(report, "mountains", mountains);
  const test::ScratchDir dir;
  const auto everest = test::sharedDir() / "data/dem-srtm3-everest";
  if (std::filesystem::exists(everest))
    if (const auto baked = terrain::openOrBake(everest, dir / "cache", {})) {
      rowsOf(report, "everest", baked.value());
      peerRowsOf(report, "everest", baked.value());
    }
  terrain::SampleOptions options;
  options.postM = report.quick() ? 180 : 90;
  if (!terrain::writeSample(dir / "sample.tif", options)) return;
  if (const auto baked = terrain::openOrBake(dir / "sample.tif", dir / "cache", {}))
    rowsOf(report, "sample", baked.value());
}

}  // namespace trimtab::bench
