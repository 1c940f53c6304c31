#include "culling_floor.h"

#include <algorithm>
#include <cstdio>
#include <random>
#include <utility>
#include <vector>

#include "bench_scene.h"
#include "culling_frames.h"
#include "trimtab/experiment/stage.h"

namespace trimtab::bench {
namespace {

/// A terrain without some of the nodes in view: their boxes stand opposite the eye, as far away as they are,
/// so that all else (levels, order) stays as it is.
class Partly final : public terrain::Database {
 public:
  Partly(std::shared_ptr<const terrain::Database> whole, Vec3 eye, const std::vector<std::uint32_t>& gone)
      : whole_(std::move(whole)), index_(whole_->index()) {
    const auto x = [&](float v) { return static_cast<float>(2 * eye.x - double{v}); };
    const auto y = [&](float v) { return static_cast<float>(2 * eye.y - double{v}); };
    const auto z = [&](float v) { return static_cast<float>(2 * eye.z - double{v}); };
    for (const std::uint32_t node : gone) {
      const Box& b = index_.bounds[node];
      index_.bounds[node] = {x(b.maxX), y(b.maxY), z(b.maxZ), x(b.minX), y(b.minY), z(b.minZ)};
    }
  }
  const terrain::TerrainInfo& info() const override { return whole_->info(); }
  const TerrainIndex& index() const override { return index_; }
  void buildTile(std::uint32_t node, terrain::TileMesh& mesh) const override {
    whole_->buildTile(node, mesh);
  }
  std::optional<Metres> heightAt(Degrees latitude, Degrees longitude) const override {
    return whole_->heightAt(latitude, longitude);
  }
  std::optional<Metres> highestWithin(Degrees latitude, Degrees longitude, Metres radius) const override {
    return whole_->highestWithin(latitude, longitude, radius);
  }

 private:
  std::shared_ptr<const terrain::Database> whole_;
  TerrainIndex index_;
};

void floorRow(Report& report, const std::string& terrain,
              const std::shared_ptr<const terrain::Database>& database, double errorPx) {
  auto created = scene::Offscreen::create(1280, 720);
  if (!created) return;
  scene::Offscreen& context = *created.value();
  context.makeCurrent();
  scene::Renderer whole, partly;
  if (!whole.initialize().usable || !partly.initialize().usable) return;
  whole.setTerrain(database);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(0.25, 0.75), heading(0, 360);
  std::vector<double> frustum, owned, sky;
  std::size_t inView = 0, owning = 0;
  const int views = report.quick() ? 3 : 6, pairs = report.quick() ? 8 : 24;
  for (int view = 0; view < views; ++view) {
    scene::FrameRequest r;
    const double east = place(random), north = place(random);
    r.attitude = {Degrees{heading(random)}, Degrees{-5}, Degrees{0}};
    r.eye = placeOver(*database, east, north, 2000 * 0.3048);
    r.view.widthPx = 1280, r.view.heightPx = 720;
    r.lod.screenSpaceError = Pixels{errorPx};
    r.method = CullingCase::view_frustum;
    scene::FrameResult result = whole.draw(r, context.framebuffer());
    std::vector<std::uint32_t> owners = whole.readNodes(true), gone;
    std::sort(owners.begin(), owners.end());
    for (const TileDraw& tile : result.visible.tiles)
      if (!std::binary_search(owners.begin(), owners.end(), tile.node)) gone.push_back(tile.node);
    partly.setTerrain(
        std::make_shared<const Partly>(database, database->index().frame.fromGeodetic(r.eye), gone));
    inView += result.visible.tiles.size();
    auto up = r;
    up.attitude.pitch = Degrees{85};
    for (int i = -2; i < pairs; ++i) {
      r.eye.height = r.eye.height + Metres{0.01};
      up.eye = r.eye;
      const double all = whole.draw(r, context.framebuffer()).cost.total;
      result = partly.draw(r, context.framebuffer());
      const double empty = whole.draw(up, context.framebuffer()).cost.total;
      if (i < 0) continue;
      frustum.push_back(all);
      owned.push_back(result.cost.total);
      sky.push_back(empty);
    }
    owning += result.visible.tiles.size();
  }
  whole.release();
  partly.release();
  const PairedRatio ratio = pairedRatio(frustum, owned);
  char what[320];
  std::snprintf(
      what, sizeof what,
      "Frame of nothing but the tiles that own a pixel, over %s: %zu of %zu in view; what no culling "
      "of whole tiles can beat; ratio of pairs: 95 %% interval %.3f to %.3f; a frame of sky alone "
      "takes %.1f ms",
      terrain.c_str(), owning / static_cast<std::size_t>(views), inView / static_cast<std::size_t>(views),
      ratio.low, ratio.high, experiment::quantileOf(sky, 0.5));
  report.add({.id = "culling.frame_" + terrain + "_2000ft" + (errorPx < 1 ? "_finest" : "") + "_floor",
              .what = what,
              .value = experiment::quantileOf(owned, 0.5),
              .unit = "ms",
              .peer = "view frustum",
              .peerValue = experiment::quantileOf(frustum, 0.5),
              .peerFrom = "run",
              .ratio = ratio.median});
}

}  // namespace

void floorRows(Report& report, const std::string& terrain,
               const std::shared_ptr<const terrain::Database>& database) {
  for (const double errorPx : {2.0, 0.05}) floorRow(report, terrain, database, errorPx);
}

}  // namespace trimtab::bench
