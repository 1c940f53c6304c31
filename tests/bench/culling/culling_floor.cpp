#include "culling_floor.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <random>
#include <vector>

#include "app/experiment/stage.h"
#include "core/scene/gl/multi_draw.h"
#include "culling_frames.h"
#include "draw_oracle.h"
#include "tests/bench/bench_scene.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/scene/renderer.h"

namespace trimtab::bench {
namespace {

/// Pictures of the same view: by the frustum, as *proposed* with the horizon, of what an oracle lets through,
/// and of the sky.
struct Way {
  enum class What { frustum, proposed, owners, sky } what;
  int blocksAcross;
};
constexpr std::array<Way, 7> kWays{{{Way::What::frustum, 0},
                                    {Way::What::proposed, 0},
                                    {Way::What::owners, 1},
                                    {Way::What::owners, 2},
                                    {Way::What::owners, 4},
                                    {Way::What::owners, 0},
                                    {Way::What::sky, 0}}};

class Floor {
 public:
  Floor(scene::Offscreen& context, std::shared_ptr<const terrain::Database> database)
      : context_(context), database_(std::move(database)) {
    usable_ = renderer_.initialize().usable;
    renderer_.setTerrain(database_);
  }
  ~Floor() { renderer_.release(); }
  bool usable() const { return usable_; }

  /// A place's frames, one of each way in turn; whether all that owners draw is the whole picture.
  bool measure(FrameRequest r, int pairs) {
    r.cullingCase = CullingCase::view_frustum;
    oracle_.letAll();
    renderer_.draw(r, context_.framebuffer());
    oracle_.learn(kWidth, kHeight);
    renderer_.draw(r, context_.framebuffer());
    draw(r, kWays[0]);
    const auto whole = renderer_.readPixels(kWidth, kHeight);
    bool same = oracle_.triangles() > 0;
    for (const Way& way : kWays) {
      if (way.what != Way::What::owners) continue;
      draw(r, way);
      same = same && renderer_.readPixels(kWidth, kHeight) == whole;
    }
    all_ += oracle_.triangles();
    owners_ += oracle_.drawn(0);
    for (int i = -2; i < pairs; ++i) {
      // A view that moves is selected anew; the owners stay those of where it began.
      r.eye.height = r.eye.height + Metres{0.01};
      for (std::size_t way = 0; way < kWays.size(); ++way)
        if (const double took = draw(r, kWays[way]); i >= 0) ms_[way].push_back(took);
    }
    return same;
  }
  double median(std::size_t way) const { return experiment::quantileOf(ms_[way], 0.5); }
  PairedRatio ratio(std::size_t way) const { return pairedRatio(ms_[0], ms_[way]); }
  double owners() const { return static_cast<double>(owners_) / static_cast<double>(all_); }

 private:
  double draw(FrameRequest r, const Way& way) {
    if (way.what == Way::What::proposed) r.cullingCase = CullingCase::proposed;
    if (way.what == Way::What::sky) r.attitude.pitch = Degrees{85};
    if (way.what == Way::What::owners)
      oracle_.letOwners(way.blocksAcross);
    else
      oracle_.letAll();
    return renderer_.draw(r, context_.framebuffer()).cost.total;
  }

  scene::Offscreen& context_;
  std::shared_ptr<const terrain::Database> database_;
  DrawOracle oracle_;
  scene::Renderer renderer_;
  bool usable_ = false;
  std::array<std::vector<double>, kWays.size()> ms_;
  std::size_t all_ = 0, owners_ = 0;
};

void floorRow(Report& report, const std::string& terrain,
              const std::shared_ptr<const terrain::Database>& database, TerrainForm form, double errorPx) {
  auto created = scene::Offscreen::create(kWidth, kHeight);
  if (!created) return;
  created.value()->makeCurrent();
  const scene::ForcedDrawWay seen(scene::DrawWay::base_vertex);
  Floor floor(*created.value(), database);
  if (!floor.usable()) return;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(0.25, 0.75), heading(0, 360);
  bool same = true;
  for (int view = 0; view < 6; ++view) {
    FrameRequest r;
    const double east = place(random), north = place(random);
    r.attitude = {Degrees{heading(random)}, Degrees{-5}, Degrees{0}};
    r.eye = placeOver(*database, east, north, 2000 * 0.3048);
    r.view.widthPx = kWidth, r.view.heightPx = kHeight;
    r.levers.drawn.errorPx = errorPx;
    r.terrain.form = form;
    r.waitForPages = true;
    r.occlusion = OcclusionMethod::horizon;
    r.levers.drawn.occlusion = OcclusionResolution{800, 600};
    same = floor.measure(r, report.quick() ? 4 : 16) && same;
  }
  const std::size_t triangles = 5;
  const PairedRatio ratio = floor.ratio(triangles);
  char what[640];
  std::snprintf(
      what, sizeof what,
      "Frame of nothing but the %.1f %% of the triangles in view that own a pixel, %s over %s%s: what "
      "no culling can beat; 95 %% interval of the ratio %.3f to %.3f; of squares of 4 x 4 a mesh with "
      "such a triangle %.3f, 2 x 2 %.3f, whole meshes %.3f, what the horizon leaves %.3f, sky alone "
      "%.3f",
      100 * floor.owners(), form == TerrainForm::patches ? "patches" : "tiles", terrain.c_str(),
      same ? "" : " (NOT THE SAME PICTURE)", ratio.low, ratio.high, floor.ratio(4).median,
      floor.ratio(3).median, floor.ratio(2).median, floor.ratio(1).median, floor.ratio(6).median);
  report.add({.id = "culling.frame_" + terrain + "_2000ft" + (errorPx < 1 ? "_finest" : "") +
                    (form == TerrainForm::patches ? "_patches" : "") + "_floor",
              .what = what,
              .value = floor.median(triangles),
              .unit = "ms",
              .peer = "view frustum",
              .peerValue = floor.median(0),
              .peerFrom = "run",
              .ratio = ratio.median});
}

}  // namespace

void floorRows(Report& report, const std::string& terrain,
               const std::shared_ptr<const terrain::Database>& database) {
  for (const TerrainForm form : {TerrainForm::tiles, TerrainForm::patches}) {
    if (form == TerrainForm::patches && !database->patches()) continue;
    for (const double errorPx : {2.0, 0.05}) floorRow(report, terrain, database, form, errorPx);
  }
}

}  // namespace trimtab::bench
