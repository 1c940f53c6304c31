#include <random>

#include "tests/core/scene/culling/culling_flight.h"
#include "trimtab/scene/planted_defects.h"

namespace trimtab {
namespace {

class Occlusion : public test::CullingFlight {
 protected:
  Occlusion() : CullingFlight(OcclusionMethod::depth_map, 60) {}
};

TEST_F(Occlusion, leavesNoPixelOutOverSyntheticMountains) {
  use(test::syntheticMountains());
  const Tally tally = fly(36, 1);
  EXPECT_EQ(tally.differing, 0u);
  EXPECT_GT(tally.served, 30);
  EXPECT_GT(tally.viewsOverFifth, 8) << "it hides hardly anything";
}

TEST_F(Occlusion, leavesNoPixelOutOverEverest) {
  TRIMTAB_NEEDS_SHARED("data/dem-srtm3-everest");
  ASSERT_TRUE(useShared("dem-srtm3-everest"));
  const Tally tally = fly(24, 2);
  EXPECT_EQ(tally.differing, 0u);
  EXPECT_GT(tally.viewsOverFifth, 8);
}

TEST_F(Occlusion, leavesNoPixelOutOverFuji) {
  TRIMTAB_NEEDS_SHARED("data/dem-osgearth-fuji");
  ASSERT_TRUE(useShared("dem-osgearth-fuji"));
  const Tally tally = fly(18, 3);
  EXPECT_EQ(tally.differing, 0u);
  EXPECT_GT(tally.viewsOverFifth, 2);
}

TEST_F(Occlusion, leavesNoPixelOutOverTheSample) {
  ASSERT_TRUE(useSample());
  const Tally tally = fly(18, 4);
  EXPECT_EQ(tally.differing, 0u);
  EXPECT_GT(tally.viewsOverFifth, 2);
}

// Without this, the tests above might pass because nothing can go wrong where they look.
TEST_F(Occlusion, losesPixelsWhenOccludersAreNotLowered) {
  use(test::syntheticMountains());
  plant(renderer, {.loweringScale = 0});
  constexpr std::array<OcclusionResolution, 2> kCoarse{{{16, 12}, {24, 18}}};
  EXPECT_GT(fly(24, 1, kCoarse).differing, 0u);
  plant(renderer, {});
  EXPECT_EQ(fly(24, 1, kCoarse).differing, 0u);
}

TEST_F(Occlusion, saysWhyItIsNotUsed) {
  use(test::syntheticMountains());
  expectReasons();
}

TEST_F(Occlusion, isSkippedWhereTheDecisionAsksForNone) {
  use(test::syntheticMountains());
  auto r = request(over(0.5, 0.5, 300), {});
  auto result = renderer.draw(r, offscreen->framebuffer());
  EXPECT_EQ(result.counters.depthMapsDrawn, 0u);
  EXPECT_TRUE(std::isnan(result.cost.occlusion));
  EXPECT_EQ(renderer.readDepthMap().width, 0);
  r.levers.drawn.occlusion = OcclusionResolution{320, 240};
  result = renderer.draw(r, offscreen->framebuffer());
  EXPECT_EQ(result.counters.depthMapsDrawn, 1u);
  EXPECT_GT(result.cost.occlusion, 0);
  r.cullingCase = CullingCase::view_frustum;
  EXPECT_EQ(renderer.draw(r, offscreen->framebuffer()).counters.depthMapsDrawn, 1u);
  EXPECT_EQ(renderer.readDepthMap().width, 0) << "an old map must not pass for this frame's";
}

TEST_F(Occlusion, showsItsDepthMapAsGreys) {
  use(test::syntheticMountains());
  auto r = request(over(0.5, 0.5, 400), {Degrees{20}, Degrees{-10}, Degrees{0}});
  r.levers.drawn.occlusion = OcclusionResolution{320, 240};
  ASSERT_TRUE(renderer.draw(r, offscreen->framebuffer()).depthMap.has_value());
  const auto grey = renderer.readDepthMap();
  ASSERT_EQ(grey.width, 320);
  ASSERT_EQ(grey.height, 240);
  // Row 0 is at the bottom, where the ground is near; the top row is sky.
  EXPECT_LT(grey.pixels[160], 200);
  EXPECT_EQ(grey.pixels[239 * 320 + 160], 255);
}

}  // namespace
}  // namespace trimtab
