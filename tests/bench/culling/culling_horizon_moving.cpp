#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "culling_horizon.h"
#include "hidden_share.h"
#include "rough_ground.h"
#include "tests/core/culling/lod_ground.h"
#include "trimtab/culling/frustum.h"
#include "trimtab/culling/moving_horizon.h"

namespace trimtab::bench {
namespace {

/// 600 kt at 60 frames a second.
constexpr double kStepM = 308.67 / 60;
const Horizon::Settings kSettings{.columns = 800, .slack = 0.02 * 1.1547 / 1280};

/// The least that each frame of a flight took in some runs of it; the first frames, in which the eye's motion
/// is not known yet, are left out.
struct FrameTimes {
  double mean = 0, slowest = 0;
};
FrameTimes frameTimes(int runs, int frames, const std::function<double(int run, int frame)>& fly) {
  constexpr int kFirst = 5;
  std::vector<double> least(static_cast<std::size_t>(frames), 1e9);
  for (int run = 0; run < runs; ++run)
    for (int frame = 0; frame < frames; ++frame) {
      double& seconds = least[static_cast<std::size_t>(frame)];
      seconds = std::min(seconds, fly(run, frame));
    }
  FrameTimes times;
  for (int frame = kFirst; frame < frames; ++frame) {
    const double seconds = least[static_cast<std::size_t>(frame)];
    times.mean += seconds / (frames - kFirst);
    times.slowest = std::max(times.slowest, seconds);
  }
  return times;
}

/// Of the rough ground: one level, so that the cut stands.
struct StandingCut {
  explicit StandingCut(const RoughGround& ground) {
    constexpr std::uint32_t kNone = TerrainIndex::kNone;
    for (std::uint32_t i = 0; i < ground.tiles().size(); ++i) {
      index.bounds.push_back(ground.boxOf(i));
      index.errorM.push_back(0);
      index.parent.push_back(kNone);
      index.children.push_back({kNone, kNone, kNone, kNone});
      tiles.push_back({.node = i});
    }
    index.neighbours = index.children;
  }
  TerrainIndex index;
  std::vector<TileDraw> tiles;
};

void addTimes(Report& report, const std::string& id, const std::string& what, const FrameTimes& times) {
  report.add(valueAtMost(0.32, {.id = "culling.horizon_moving_" + id,
                                .what = "Horizon a frame at 600 kt, mean: " + what,
                                .value = 1e3 * times.mean,
                                .unit = "ms"}));
  report.add({.id = "culling.horizon_moving_slowest_" + id,
              .what = "Horizon a frame at 600 kt, the slowest: " + what,
              .value = 1e3 * times.slowest,
              .unit = "ms"});
}

void standingRows(Report& report) {
  const RoughGround ground;
  const StandingCut cut(ground);
  const SurfaceTree tree = SurfaceTree::of(cut.index);
  const int flights = report.quick() ? 2 : 6, frames = 90, runs = report.quick() ? 2 : 4;
  for (const double aboveM : {100.0, 400.0, 1500.0}) {
    RoughViews eyes(ground, 1);
    FrameTimes all;
    HiddenShare share, fromScratch;
    double lookUp = 0;
    for (int flight = 0; flight < flights; ++flight) {
      const EyePose start = eyes.next(aboveM);
      Vec3 from = start.position;
      const Vec3 forward = -start.axes.row[2];
      for (int frame = 0; frame < frames; ++frame) {
        const Vec3 on = from + (kStepM * frame) * forward;
        from.z = std::max(from.z, ground.heightAt(on.x, on.y) + 20);
      }
      MovingHorizon moving;
      const FrameTimes times = frameTimes(runs, frames, [&](int run, int frame) {
        if (frame == 0) moving.clear();
        const Vec3 eye = from + (kStepM * frame) * forward;
        const double begun = monotonicSeconds();
        const auto hidden = moving.hidden(
            {.eye = eye, .cut = 1, .tiles = cut.tiles, .errorOverDistance = 0.002, .settings = kSettings},
            tree, [&](std::vector<HorizonTile>& tiles) { tiles = ground.tiles(); });
        const double took = monotonicSeconds() - begun;
        if (run > 0 || frame % 30 != 29) return took;
        Horizon scratch;
        scratch.build(eye, ground.tiles(), kSettings);
        const EyePose pose{eye, start.axes};
        const ViewShape view;
        const std::vector<std::uint8_t> owns = ground.owners(pose, view);
        const Frustum frustum(pose, view);
        std::vector<std::uint32_t> inView;
        for (std::uint32_t t = 0; t < owns.size(); ++t) {
          if (!frustum.mayShow(ground.boxOf(t))) continue;
          inView.push_back(t);
          share.add(owns[t] != 0, hidden[t] != 0);
          fromScratch.add(owns[t] != 0, scratch.hidden()[t] != 0);
        }
        lookUp = std::max(lookUp, leastSeconds(5, [&] {
                            std::size_t left = 0;
                            for (const std::uint32_t t : inView) left += hidden[t];
                            keep(left);
                          }));
        return took;
      });
      all.mean += times.mean / flights;
      all.slowest = std::max(all.slowest, times.slowest);
    }
    const std::string above = std::to_string(static_cast<int>(aboveM)) + "m";
    addTimes(report, above, "6,400 tiles, a cut that stands, " + above + " above fractal ground", all);
    const auto percent = [](const HiddenShare& of) {
      return 100.0 * static_cast<double>(of.culled) / static_cast<double>(of.hidden);
    };
    report.add({.id = "culling.horizon_moving_share_" + above,
                .what = "Of the tiles in view that own no pixel, left out in flight, and from scratch",
                .value = percent(share),
                .unit = "%",
                .peer = "from scratch in the same frames",
                .peerValue = percent(fromScratch),
                .peerFrom = "run"});
    report.add(valueAtMost(0, {.id = "culling.horizon_moving_wrong_" + above,
                               .what = "Tiles that own a pixel and are left out in flight",
                               .value = static_cast<double>(share.wrong),
                               .unit = "tiles"}));
    report.add(valueAtMost(0.1, {.id = "culling.horizon_view_" + above,
                                 .what = "Which tiles of a view are hidden, once the horizon stands",
                                 .value = 1e3 * lookUp,
                                 .unit = "ms"}));
  }
}

/// Levels by the rule of the terrain, 2 pixels at 1280x720; the cut is selected outside the time.
void levelRows(Report& report) {
  test::LodGround ground(64, 30, 9);
  const SurfaceTree tree = SurfaceTree::of(ground.index());
  const double errorOverDistance = 2 * 1.1547 / 1280;
  const int frames = 120, runs = report.quick() ? 2 : 4;
  for (const double aboveM : {100.0, 400.0, 1500.0}) {
    const double side = ground.sideM();
    const Vec3 from{0.4 * side, 0.4 * side, 0}, forward{0.8, 0.6, 0};
    double highest = 0;
    for (int frame = 0; frame < frames; ++frame) {
      const Vec3 on = from + (kStepM * frame) * forward;
      highest = std::max(highest, ground.sourceAt(on.x, on.y));
    }
    MovingHorizon moving;
    LevelCut cut;
    std::vector<TileDraw> last;
    std::uint64_t cuts = 0, firstBuilt = 0;
    std::size_t hiddenTiles = 0, hiddenFromScratch = 0, tilesOfCuts = 0, changes = 0;
    const FrameTimes times = frameTimes(runs, frames, [&](int run, int frame) {
      if (frame == 0) moving.clear();
      if (frame == 5) firstBuilt = moving.fromScratch();
      const Vec3 eye = from + (kStepM * frame) * forward + Vec3{0, 0, highest + aboveM};
      selectLevels(ground.index(), eye, {errorOverDistance, 1, 1}, cut);
      if (!std::equal(last.begin(), last.end(), cut.tiles.begin(), cut.tiles.end(),
                      [](const TileDraw& a, const TileDraw& b) {
                        return a.node == b.node && a.border == b.border;
                      })) {
        last = cut.tiles;
        ++cuts;
        changes += run == 0;
      }
      const double start = monotonicSeconds();
      const auto hidden =
          moving.hidden({.eye = eye,
                         .cut = cuts,
                         .tiles = cut.tiles,
                         .errorOverDistance = errorOverDistance,
                         .settings = kSettings},
                        tree, [&](std::vector<HorizonTile>& tiles) { tiles = ground.tiles(cut); });
      const double took = monotonicSeconds() - start;
      if (run == 0 && frame % 10 == 9) {
        Horizon scratch;
        scratch.build(eye, ground.tiles(cut), kSettings);
        hiddenFromScratch += scratch.hiddenCount();
        hiddenTiles += static_cast<std::size_t>(std::count(hidden.begin(), hidden.end(), 1));
        tilesOfCuts += cut.tiles.size();
      }
      return took;
    });
    const std::string above = std::to_string(static_cast<int>(aboveM)) + "m";
    addTimes(report, "levels_" + above,
             std::to_string(cut.tiles.size()) + " tiles, " + std::to_string(changes) + " cuts in " +
                 std::to_string(frames) + " frames, " + std::to_string(moving.fromScratch() - firstBuilt) +
                 " builds at once, " + above + " above rough ground",
             times);
    report.add({.id = "culling.horizon_moving_levels_share_" + above,
                .what = "Tiles of the cut proven hidden in flight over ground in levels, of " +
                        std::to_string(tilesOfCuts),
                .value = static_cast<double>(hiddenTiles),
                .unit = "tiles",
                .peer = "from scratch in the same frames",
                .peerValue = static_cast<double>(hiddenFromScratch),
                .peerFrom = "run"});
  }
}

}  // namespace

void movingHorizonRows(Report& report) {
  if (report.wants("horizon_moving")) standingRows(report);
  if (report.wants("horizon_levels")) levelRows(report);
}

}  // namespace trimtab::bench
