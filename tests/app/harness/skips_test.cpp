#include "app/harness/skips.h"

#include <chrono>
#include <cmath>
#include <set>
#include <thread>
#include <utility>

#include "tests/core/scene/scene_test.h"
#include "tests/core/scene/terrain/synthetic_trees.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/preset/table.h"

namespace trimtab {
namespace {

using harness::Skip;
using harness::skips;
using harness::SkipSaving;

class SkipsTest : public test::SceneTest {
 protected:
  harness::DrawFrame drawFrame() {
    return [this](const FrameRequest& r) { return renderer.draw(r, offscreen->framebuffer()); };
  }
  /// A standing eye whose head turns, with symbols, at rest in clear air, in scheme frustum.
  FrameRequest looking(double heading) const {
    auto r = request(over(0.4, 0.4, 60), {Degrees{heading}, Degrees{-1}, Degrees{3}});
    r.view.widthPx /= 2;
    r.view.heightPx /= 2;
    r.levers.drawn.errorPx = 0.7;
    r.time = heading;
    TuningParameters p;
    p.symbology.enabled = true;
    const Attitude level{Degrees{30}, Degrees{-2}, Degrees{0}};
    r.symbology = SymbologyRequest{{level, level, Metres{1234}, Knots{240}, true, {}}, symbologySetup(p)};
    return r;
  }
  static void foggy(FrameRequest& r) {
    r.decision.weather.fogged = true;
    r.decision.weather.visibilityM = 9000;
    r.decision.weather.extinctionPerM = 3.912 / 9000;
    r.levers.drawn.farM = 9000;
  }
  const SkipSaving& saving(const std::vector<SkipSaving>& savings, std::string_view name) {
    for (const SkipSaving& s : savings)
      if (s.name == name) return s;
    ADD_FAILURE() << name;
    return savings.front();
  }
};

TEST_F(SkipsTest, changeNoPixelWhetherTheirWorkIsDoneOrNot) {
  struct Scene {
    const char* name;
    void (*set)(FrameRequest&);
    double climbM = 0;  ///< from the first frame to the second
    double turnDeg = 20;
  };
  const Scene kScenes[] = {
      {"scheme frustum", [](FrameRequest&) {}},
      {"depth map",
       [](FrameRequest& r) {
         r.levers.drawn.occlusion = OcclusionResolution{400, 300};
       }},
      {"horizon",
       [](FrameRequest& r) {
         r.levers.drawn.occlusion = OcclusionResolution{400, 300};
         r.occlusion = OcclusionMethod::horizon;
       }},
      {"climb high above, horizon",
       [](FrameRequest& r) {
         r.eye.height = r.eye.height + Metres{3000};
         r.levers.drawn.occlusion = OcclusionResolution{400, 300};
         r.occlusion = OcclusionMethod::horizon;
       },
       20},
      {"view that stands", [](FrameRequest&) {}, 0, 0},
      {"fog", foggy},
      {"fog, depth map",
       [](FrameRequest& r) {
         foggy(r);
         r.levers.drawn.occlusion = OcclusionResolution{400, 300};
       }},
      {"trees", [](FrameRequest& r) { r.terrain.form = TerrainForm::static_trees; }},
      {"trees in fog",
       [](FrameRequest& r) {
         foggy(r);
         r.terrain.form = TerrainForm::static_trees;
       }},
  };
  use(std::make_shared<const test::TreeTerrain>(test::syntheticMountains()));
  double heading = 0;  // where something is hidden
  for (FrameResult result; heading < 360; heading += 15) {
    auto r = looking(heading);
    r.levers.drawn.occlusion = OcclusionResolution{400, 300};
    picture(r, &result);
    if (result.visible.occluded > 0) break;
  }
  std::set<std::string_view> met;
  for (const Scene& scene : kScenes) {
    std::vector<FrameRequest> frames{looking(heading - scene.turnDeg), looking(heading)};
    for (FrameRequest& r : frames) scene.set(r);
    frames[1].eye.height = frames[1].eye.height + Metres{scene.climbM};
    FrameResult before, after;
    picture(frames[0], &before);
    const auto plain = picture(frames[1], &after);
    for (const Skip& skip : skips()) {
      if (!skip.left(frames[1], before, after)) continue;
      met.insert(skip.name);
      FrameResult done;
      EXPECT_EQ(differing(plain, picture(skip.done(frames[1]), &done)), 0u)
          << skip.name << ", " << scene.name;
      EXPECT_EQ(differing(plain, picture(skip.leftOut(frames[1]))), 0u) << skip.name << ", " << scene.name;
      EXPECT_EQ(differing(plain, picture(frames[1])), 0u) << skip.name << " leaves something behind";
    }
  }
  for (const Skip& skip : skips())
    EXPECT_TRUE(met.count(skip.name)) << "no scene here leaves out: " << skip.name;
}

TEST_F(SkipsTest, areDoneWhereTheyAreSwitchedOff) {
  use(test::syntheticMountains());
  auto r = looking(20);
  foggy(r);
  FrameResult before, after;
  const auto drawTwice = [&](bool Skips::*skip) {
    auto changed = r;
    if (skip != nullptr) changed.skips.*skip = false;
    picture(changed);
    picture(changed, &before);
    picture(changed, &after);
  };
  const auto work = [&] {
    return std::array{after.counters.cutsSelected - before.counters.cutsSelected,
                      after.counters.tilesBuilt - before.counters.tilesBuilt,
                      after.counters.blurPasses - before.counters.blurPasses,
                      after.counters.precipitationPasses - before.counters.precipitationPasses,
                      after.counters.symbologyRedraws - before.counters.symbologyRedraws};
  };
  using Work = std::array<std::uint64_t, 5>;
  drawTwice(nullptr);
  EXPECT_EQ(work(), (Work{0, 0, 0, 0, 0}));
  const std::size_t tiles = after.visible.tiles.size();
  EXPECT_GT(after.visible.beyondVisibility, 0u);
  drawTwice(&Skips::sameCut);
  EXPECT_EQ(work(), (Work{1, 0, 0, 0, 0}));
  drawTwice(&Skips::tilesOnGpu);
  EXPECT_EQ(work(), (Work{0, tiles, 0, 0, 0}));
  drawTwice(&Skips::blurAtRest);
  EXPECT_EQ(work(), (Work{0, 0, 1, 0, 0}));
  drawTwice(&Skips::clearAir);
  EXPECT_EQ(work(), (Work{0, 0, 0, 1, 0}));
  drawTwice(&Skips::sameSymbols);
  EXPECT_EQ(work(), (Work{0, 0, 0, 0, 1}));
  drawTwice(&Skips::beyondVisibility);
  EXPECT_EQ(work(), (Work{0, 0, 0, 0, 0}));
  EXPECT_EQ(after.visible.beyondVisibility, 0u);
  EXPECT_GT(after.visible.tiles.size(), tiles);
}

TEST_F(SkipsTest, areCountedByFrameAndMeasured) {
  constexpr int kTilesMs = 200;
  use(test::syntheticMountains());
  // Three looks around, then two places on; it rains in the last one, and it is blurred.
  std::vector<FrameRequest> frames{looking(0), looking(10), looking(20), looking(20), looking(20)};
  frames[3].eye = over(0.42, 0.4, 60);
  frames[4].eye = over(0.44, 0.4, 60);
  frames[4].decision.weather.precipitation = Precipitation::rain;
  frames[4].decision.weather.density = 0.5;
  frames[4].levers.drawn.blurStrength = 0.5;
  frames[2].levers.drawn.occlusion = OcclusionResolution{400, 300};
  // A frame that makes tiles takes long here, so that no machine hides which of the two it is.
  std::uint64_t built = 0;
  const auto slowTiles = [&](const FrameRequest& r) {
    FrameResult result = drawFrame()(r);
    if (std::exchange(built, result.counters.tilesBuilt) != result.counters.tilesBuilt)
      std::this_thread::sleep_for(std::chrono::milliseconds(kTilesMs));
    return result;
  };
  const std::vector<SkipSaving> savings = harness::measureSkips(slowTiles, frames, 2);
  ASSERT_EQ(savings.size(), skips().size());
  const struct {
    const char* name;
    std::uint64_t skipped, frames;
  } kExpected[] = {{"levels chosen again for an eye that stands", 2, 4},
                   {"blur at rest", 4, 5},
                   {"precipitation in clear air", 4, 5},
                   {"symbols that have not changed", 4, 4},
                   {"occlusion test in scheme frustum", 4, 5},
                   {"tiles outside the frustum", 5, 5},
                   {"tiles that the GPU holds already", 5, 5},
                   {"tiles beyond visibility", 0, 5},
                   {"tiles in view chosen again for a view that stands", 0, 4},
                   {"horizon built again for an eye that stands", 0, 4},
                   {"horizon where it hid next to nothing", 0, 4}};
  for (const auto& [name, skipped, count] : kExpected) {
    const SkipSaving& s = saving(savings, name);
    EXPECT_EQ(s.skipped, skipped) << name;
    EXPECT_EQ(s.frames, count) << name;
    EXPECT_EQ(s.ratio.pairs, 2 * skipped) << name;
    EXPECT_EQ(std::isnan(s.savedMs), skipped == 0) << name;
    EXPECT_EQ(std::isnan(s.ratio.median), skipped == 0) << name;
  }
  const SkipSaving& tiles = saving(savings, "tiles that the GPU holds already");
  EXPECT_GT(tiles.savedMs, 0.5 * kTilesMs);
  EXPECT_GT(tiles.ratio.median, 1);
}

TEST_F(SkipsTest, areLeftUnmeasuredWhenAskedToStop) {
  use(test::syntheticMountains());
  const std::vector<FrameRequest> frames{looking(0), looking(10)};
  int asked = 0;
  const auto savings = harness::measureSkips(drawFrame(), frames, 3, [&asked] { return ++asked <= 2; });
  ASSERT_EQ(savings.size(), skips().size());
  EXPECT_EQ(saving(savings, "blur at rest").skipped, 2u);
  for (const SkipSaving& s : savings) EXPECT_TRUE(std::isnan(s.savedMs)) << s.name;
  EXPECT_EQ(harness::measureSkips(drawFrame(), {}, 3).size(), skips().size());
}

}  // namespace
}  // namespace trimtab
