#include "core/scene/occlusion/map_culling.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/scene/planted_defects.h"

#include <random>

#include "tests/core/scene/culling/culling_flight.h"
#include "tests/core/scene/terrain/patched_terrain.h"

namespace trimtab {
namespace {

class MapScene : public test::CullingFlight {
 protected:
  explicit MapScene(OcclusionMethod method = OcclusionMethod::cpu_map) : CullingFlight(method, 15) {}
};

TEST_F(MapScene, leavesNoPixelOutOverSyntheticMountains) {
  use(test::syntheticMountains());
  const Tally tally = fly(24, 1);
  EXPECT_EQ(tally.differing, 0u);
  EXPECT_GT(tally.served, 20);
  EXPECT_LT(tally.proposed * 10, tally.frustum * 9) << "it hides hardly anything";
}

TEST_F(MapScene, leavesNoPixelOutOverEverest) {
  TRIMTAB_NEEDS_SHARED("data/dem-srtm3-everest");
  ASSERT_TRUE(useShared("dem-srtm3-everest"));
  const Tally tally = fly(18, 2);
  EXPECT_EQ(tally.differing, 0u);
  EXPECT_LT(tally.proposed * 10, tally.frustum * 8);
}

// Without this, the tests above might pass because nothing can go wrong where they look.
TEST_F(MapScene, losesPixelsWhereOccludersAreNotLowered) {
  use(test::syntheticMountains());
  constexpr std::array<OcclusionResolution, 2> kCoarse{{{16, 12}, {24, 18}}};
  plant(renderer, {.loweringScale = 0});
  EXPECT_GT(fly(12, 1, kCoarse).differing, 0u);
  plant(renderer, {});
  EXPECT_EQ(fly(12, 1, kCoarse).differing, 0u);
}

TEST_F(MapScene, leavesNoPixelOfPatchesOut) {
  use(test::patchedMountains(false));
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(0.2, 0.8), unit(0, 1);
  Tally tally;
  for (int i = 0; i < 40; ++i) {
    auto r = request(over(place(random), place(random), 15 * std::pow(300, unit(random) * unit(random))),
                     {Degrees{360 * unit(random)}, Degrees{-25 + 30 * unit(random)},
                      Degrees{i % 3 == 0 ? 360 * unit(random) : 0}});
    r.terrain.form = TerrainForm::patches;
    r.waitForPages = true;
    r.levers.drawn.errorPx = i % 2 == 0 ? 0.25 : 1.0;
    compare(r, kSizes[static_cast<std::size_t>(i) % kSizes.size()], tally);
  }
  std::printf("%zu patches by frustum, %zu proposed, %d tested\n", tally.frustum, tally.proposed,
              tally.served);
  EXPECT_EQ(tally.differing, 0u);
  EXPECT_GT(tally.served, 30);
  EXPECT_LT(tally.proposed * 100, tally.frustum * 95) << "it hides hardly anything";
}

TEST_F(MapScene, showsItsMapAsGreys) {
  use(test::syntheticMountains());
  auto r = request(over(0.5, 0.5, 400), {Degrees{20}, Degrees{-10}, Degrees{0}});
  r.levers.drawn.occlusion = OcclusionResolution{320, 240};
  for (const OcclusionMethod method : {OcclusionMethod::cpu_map, OcclusionMethod::depth_map}) {
    r.occlusion = method;
    FrameResult result;
    picture(r, &result);
    ASSERT_EQ(result.occlusion, method);
    const auto grey = renderer.readDepthMap();
    ASSERT_EQ(grey.width, 320);
    ASSERT_EQ(grey.height, 240);
    EXPECT_LT(grey.pixels[160], 200) << "near ground below";
    EXPECT_EQ(grey.pixels[239 * 320 + 160], 255) << "sky above";
  }
}

}  // namespace
}  // namespace trimtab
