#include <cmath>

#include "core/scene/occlusion/horizon_memory.h"
#include "core/scene/terrain/tiles/tile_ground.h"
#include "tests/core/scene/culling/culling_flight.h"
#include "tests/core/scene/terrain/patched_terrain.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/scene/planted_defects.h"

namespace trimtab {
namespace {

class HorizonScene : public test::CullingFlight {
 protected:
  HorizonScene() : CullingFlight(OcclusionMethod::horizon, 15) {}
};

TEST_F(HorizonScene, leavesNoPixelOutOverSyntheticMountains) {
  use(test::syntheticMountains());
  const Tally tally = fly(36, 1);
  EXPECT_EQ(tally.differing, 0u);
  EXPECT_GT(tally.served, 30);
  EXPECT_LT(tally.proposed * 10, tally.frustum * 9) << "it hides hardly anything";
}

TEST_F(HorizonScene, leavesNoPixelOutOverEverest) {
  TRIMTAB_NEEDS_SHARED("data/dem-srtm3-everest");
  ASSERT_TRUE(useShared("dem-srtm3-everest"));
  const Tally tally = fly(24, 2);
  EXPECT_EQ(tally.differing, 0u);
  EXPECT_LT(tally.proposed * 10, tally.frustum * 8);
}

TEST_F(HorizonScene, leavesNoPixelOutOverFuji) {
  TRIMTAB_NEEDS_SHARED("data/dem-osgearth-fuji");
  ASSERT_TRUE(useShared("dem-osgearth-fuji"));
  const Tally tally = fly(18, 3);
  EXPECT_EQ(tally.differing, 0u);
}

TEST_F(HorizonScene, leavesNoPixelOutOverTheSample) {
  ASSERT_TRUE(useSample());
  const Tally tally = fly(18, 4);
  EXPECT_EQ(tally.differing, 0u);
}

// Without this, the tests above might pass because nothing can go wrong where they look.
TEST_F(HorizonScene, losesPixelsWhereLinesReachTooHigh) {
  use(test::syntheticMountains());
  constexpr std::array<OcclusionResolution, 1> kCoarse{{{8, 6}}};
  plant(renderer, {.loweringScale = 0});
  EXPECT_GT(fly(24, 1, kCoarse).differing, 0u);
  plant(renderer, {});
  EXPECT_EQ(fly(24, 1, kCoarse).differing, 0u);
}

TEST_F(HorizonScene, isNotBuiltAgainWhileOnlyTheHeadTurns) {
  use(test::syntheticMountains());
  auto r = request(over(0.5, 0.5, 200), {});
  r.levers.drawn.occlusion = OcclusionResolution{320, 240};
  r.occlusion = OcclusionMethod::horizon;
  FrameResult result;
  for (int i = 0; i < 12; ++i) {
    r.attitude = {Degrees{31.0 * i}, Degrees{-3.0 * i}, Degrees{7.0 * i}};
    picture(r, &result);
    EXPECT_TRUE(result.horizon);
    EXPECT_EQ(result.counters.horizonsBuilt, 1u);
  }
  EXPECT_EQ(result.counters.depthMapsDrawn, 0u);
  r.skips.sameHorizon = false;
  const auto skipped = picture(r, &result);
  EXPECT_EQ(result.counters.horizonsBuilt, 2u);
  r.skips.sameHorizon = true;
  EXPECT_EQ(picture(r, &result), skipped);
  EXPECT_EQ(result.counters.horizonsBuilt, 2u);
  r.eye.height = r.eye.height + Metres{1};
  picture(r, &result);
  EXPECT_EQ(result.counters.horizonsBuilt, 3u);
  r.levers.drawn.occlusion = OcclusionResolution{800, 600};
  picture(r, &result);
  EXPECT_EQ(result.counters.horizonsBuilt, 4u) << "the band sets its resolution";
  r.levers.drawn.occlusion.reset();
  picture(r, &result);
  EXPECT_FALSE(result.horizon);
  EXPECT_TRUE(std::isnan(result.cost.occlusion));
  EXPECT_EQ(result.visible.occluded, 0u);
}

/// A head at 200 degrees a second, to and fro and up and down.
TEST_F(HorizonScene, isNeitherBuiltNorMovedForAHeadThatTurns) {
  for (const bool patches : {false, true})
    for (const OcclusionMethod method : {OcclusionMethod::horizon, OcclusionMethod::automatic}) {
      if (patches)
        use(test::patchedMountains(false));
      else
        use(test::syntheticMountains());
      auto r = request(over(0.44, 0.5, 60), {Degrees{40}, Degrees{-3}, Degrees{0}});
      r.levers.drawn.occlusion = OcclusionResolution{320, 240};
      r.occlusion = method;
      r.levers.drawn.errorPx = 0.5;
      r.reproducible = r.waitForPages = true;
      FrameResult first, result;
      picture(r, &first);
      std::size_t hidden = 0;
      for (int i = 0; i < 100; ++i) {
        const double turned = 200.0 / 60 * (i < 60 ? i : 120 - i);
        r.attitude = {Degrees{40 + turned}, Degrees{-3 - 0.1 * turned}, Degrees{0.05 * turned}};
        picture(r, &result);
        ASSERT_TRUE(result.horizon) << i << ' ' << result.note;
        ASSERT_EQ(result.counters.horizonsBuilt, first.counters.horizonsBuilt) << i;
        ASSERT_EQ(result.counters.horizonsMoved, first.counters.horizonsMoved) << i;
        hidden += result.visible.occluded;
      }
      EXPECT_EQ(result.counters.cutsSelected, first.counters.cutsSelected);
      EXPECT_GT(hidden, 0u) << "nothing to be seen of a horizon";
    }
}

TEST_F(HorizonScene, isNotBuiltAgainNearWhereItHidNextToNothing) {
  use(test::syntheticMountains());
  auto r = request(over(0.5, 0.5, 3000), {Degrees{40}, Degrees{-15}, {}});
  r.levers.drawn.occlusion = OcclusionResolution{320, 240};
  r.occlusion = OcclusionMethod::horizon;
  FrameResult result;
  const auto draw = [&](std::uint64_t built, std::uint64_t leftOut, const char* what) {
    const std::uint64_t before = result.counters.horizonsLeftOut;
    const auto drawn = picture(r, &result);
    EXPECT_EQ(result.occlusion, OcclusionMethod::horizon) << what;
    EXPECT_EQ(result.horizon, result.counters.horizonsLeftOut == before)
        << what << ": no profile of elsewhere";
    EXPECT_EQ(result.counters.horizonsBuilt, built) << what;
    EXPECT_EQ(result.counters.horizonsLeftOut, leftOut) << what;
    EXPECT_EQ(renderer.readHorizon(8).empty(), !result.horizon) << what;
    EXPECT_EQ(renderer.readDepthMap().pixels.size(), result.horizon ? 320u * 240u : 0u) << what;
    auto whole = r;
    whole.cullingCase = CullingCase::none;
    EXPECT_EQ(differing(drawn, picture(whole)), 0u) << what;
    EXPECT_TRUE(renderer.readDepthMap().pixels.empty()) << what;
  };
  const Metres start = r.eye.height;
  draw(1, 0, "at first");
  ASSERT_LT(result.visible.occluded * 50, result.visible.tiles.size()) << "no place for this test";
  draw(1, 0, "the same place");
  r.eye.height = start + Metres{20};
  draw(1, 1, "20 m on");
  EXPECT_EQ(result.visible.occluded, 0u);
  r.skips.sameHorizon = false;
  draw(1, 2, "another skip");
  r.skips.sameHorizon = true;
  r.eye.height = start + Metres{49};
  draw(1, 3, "49 m on");
  r.eye.height = start + Metres{51};
  draw(2, 3, "51 m on");
  r.eye.height = start + Metres{70};
  draw(2, 4, "19 m from there");
  r.levers.drawn.errorPx = 3.5;
  draw(3, 4, "other levels");
  r.skips.littleHidden = false;
  r.eye.height = start + Metres{75};
  const std::uint64_t moved = result.counters.horizonsMoved;
  draw(3, 4, "5 m on, switched off");
  EXPECT_EQ(result.counters.horizonsMoved, moved + 1) << "the last one holds here too";
  // An eye that has come to rest is given a horizon of its place alone, once.
  draw(4, 4, "the same place, switched off");
  draw(4, 4, "again");
}

TEST_F(HorizonScene, isUsedOnceAnEyeAtRestHasABetterOne) {
  use(test::syntheticMountains());
  auto r = request({}, {Degrees{40}, Degrees{-10}, Degrees{0}});
  r.levers.drawn.occlusion = OcclusionResolution{320, 240};
  r.occlusion = OcclusionMethod::horizon;
  r.levers.drawn.errorPx = 0.1;
  r.skips.littleHidden = false;
  r.waitForPages = true;
  FrameResult flying, resting, anew;
  std::size_t before = 0, after = 0;
  for (const double east : {0.4, 0.45, 0.5, 0.55}) {
    for (int i = 0; i < 12; ++i) {
      r.eye = over(east, 0.5 + 8e-4 * i, 60);
      picture(r, &flying);
    }
    for (int i = 0; i < 20; ++i) picture(r, &resting);
    const std::uint64_t selected = resting.counters.visibleSelected;
    picture(r, &resting);
    EXPECT_EQ(resting.counters.visibleSelected, selected) << "nothing is done any more";
    auto again = r;
    again.skips.sameVisible = false;
    picture(again, &anew);
    EXPECT_EQ(resting.visible.occluded, anew.visible.occluded) << east;
    before += flying.visible.occluded;
    after += resting.visible.occluded;
  }
  EXPECT_LT(before, after) << "no place for this test";
}

TEST(HorizonMemory, knowsHowFastTheEyeGoesAlsoWhereItIsNotAsked) {
  const auto database = test::syntheticMountains();
  scene::TileGround ground;
  LevelCut cut;
  scene::CutNumber number{1, 1, 0.2 / 640};
  ground.setDatabase(database);
  ground.setCut(cut, number);
  ground.share().begin(1000);
  scene::HorizonMemory memory;
  GeodeticPosition place = scene::placeIn(database->info(), 0.5, 0.5);
  place.height = database->heightAt(place.latitude, place.longitude).value() + Metres{200};
  Vec3 eye = database->index().frame.fromGeodetic(place);
  for (int frame = 0; frame <= 100; ++frame) {
    memory.beginFrame();
    if (frame % 10 == 0) {
      selectLevels(database->index(), eye, {0.2, 1, 640}, cut);
      ++number.cut;
      memory.find(ground, eye, {}, {.littleHidden = false});
      const ValidityRegion& region = memory.horizon().region();
      EXPECT_LT(length(region.to - region.from), 30 * 5.0) << "frame " << frame;
    }
    eye = eye + Vec3{5, 0, 0};
  }
}

// 100 boxes, 2 km above the eye or 300 m below it, 10 km to the north. The eye flies 200 m in steps of 5 m.
TEST(HorizonMemory, boxesAreTestedAgainFiftyMetresOnWhereNextToNoneWasHidden) {
  const auto database = test::syntheticMountains();
  const auto framesWithBoxes = [&](double aboveEyeM, bool skips) {
    scene::TileGround ground;
    LevelCut cut;
    scene::CutNumber number{1, 1, 0.2 / 640};
    ground.setDatabase(database);
    ground.setCut(cut, number);
    ground.share().begin(1000);
    GeodeticPosition place = scene::placeIn(database->info(), 0.5, 0.3);
    place.height = database->heightAt(place.latitude, place.longitude).value() + Metres{100};
    Vec3 eye = database->index().frame.fromGeodetic(place);
    ObjectIndex objects;
    for (int i = 0; i < 100; ++i) {
      const auto x = static_cast<float>(eye.x + 20 * i), y = static_cast<float>(eye.y + 10000),
                 z = static_cast<float>(eye.z + aboveEyeM);
      objects.cells.push_back({.bounds = {x, y, z, x + 10, y + 10, z + 10}});
    }
    ground.setObjects(&objects);
    scene::HorizonMemory memory;
    int tested = 0;
    for (int frame = 0; frame < 40; ++frame) {
      memory.beginFrame();
      selectLevels(database->index(), eye, {0.2, 1, 640}, cut);
      ++number.cut;
      const auto found = memory.find(ground, eye, {}, {.littleHidden = skips});
      EXPECT_FALSE(found.hidden.empty());
      tested += !found.hiddenBoxes.empty();
      eye = eye + Vec3{5, 0, 0};
    }
    return tested;
  };
  EXPECT_EQ(framesWithBoxes(2000, false), 40);
  const int inTheSky = framesWithBoxes(2000, true);
  EXPECT_GT(inTheSky, 3) << "the first place, and others 50 m on";
  EXPECT_LT(inTheSky, 30);
  EXPECT_EQ(framesWithBoxes(-300, true), 40) << "most of them are hidden";
}

TEST(HorizonSlack, followsTheRasterisersSteps) {
  ViewShape view;
  view.left = -1, view.right = 1, view.bottom = -0.5, view.top = 0.5;
  view.widthPx = 1000, view.heightPx = 1000;
  const double pixel = 2.0 / 1000;
  for (const int bits : {4, 6, 8, 12})
    EXPECT_GE(scene::HorizonMemory::slackOf(view, bits), 2 * pixel / std::ldexp(1.0, bits)) << bits;
  EXPECT_DOUBLE_EQ(scene::HorizonMemory::slackOf(view, 4), 16 * scene::HorizonMemory::slackOf(view, 8));
  EXPECT_LT(scene::HorizonMemory::slackOf(view, 8), 0.05 * pixel);
}

TEST_F(HorizonScene, hidesMoreAtTheSizeOfAHigherBand) {
  use(test::syntheticMountains());
  std::array<std::size_t, 3> occluded{};
  constexpr std::array<int, 3> kWidths{16, 64, 800};
  for (std::size_t k = 0; k < kWidths.size(); ++k)
    for (int i = 0; i < 8; ++i) {
      auto r = request(over(0.3 + 0.05 * i, 0.6 - 0.04 * i, 120), {Degrees{45.0 * i}, Degrees{-3}, {}});
      r.levers.drawn.errorPx = 0.25;
      r.occlusion = OcclusionMethod::horizon;
      r.levers.drawn.occlusion = OcclusionResolution{kWidths[k], kWidths[k] * 3 / 4};
      FrameResult result;
      picture(r, &result);
      occluded[k] += result.visible.occluded;
    }
  EXPECT_LT(occluded[0], occluded[1]);
  EXPECT_LT(occluded[1], occluded[2]);
}

TEST_F(HorizonScene, saysWhyItIsNotUsed) {
  use(test::syntheticMountains());
  expectReasons();
}

}  // namespace
}  // namespace trimtab
