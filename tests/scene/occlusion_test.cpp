#include <random>

#include "scene_test.h"

namespace trimtab {
namespace {

using test::SceneTest;

constexpr std::array<DepthMapSize, 6> kSizes{
    {{64, 48}, {320, 240}, {400, 300}, {640, 480}, {800, 600}, {33, 77}}};

struct Tally {
  int views = 0, viewsOverFifth = 0, maps = 0;
  std::size_t differing = 0, frustum = 0, proposed = 0;
};

class Occlusion : public SceneTest {
 protected:
  /// The three culling cases of one view: pictures must be equal, and the case *proposed* draws no more.
  void compare(scene::FrameRequest r, DepthMapSize size, Tally& tally) {
    scene::FrameResult frustum, proposed;
    r.decision.depthMap = size;
    r.method = CullingCase::none;
    const auto whole = picture(r);
    r.method = CullingCase::view_frustum;
    const std::size_t frustumDiffers = differing(whole, picture(r, &frustum));
    r.method = CullingCase::proposed;
    const std::size_t proposedDiffers = differing(whole, picture(r, &proposed));
    EXPECT_EQ(frustumDiffers, 0u) << "view " << tally.views;
    EXPECT_LE(proposed.visible.tiles.size(), frustum.visible.tiles.size());
    ++tally.views;
    tally.maps += proposed.depthMap.has_value();
    tally.differing += proposedDiffers;
    tally.frustum += frustum.visible.tiles.size();
    tally.proposed += proposed.visible.tiles.size();
    tally.viewsOverFifth += proposed.visible.occluded * 5 > frustum.visible.tiles.size();
  }

  /// TRIMTAB_SOAK in the environment multiplies the views.
  static int soak() {
    const char* text = std::getenv("TRIMTAB_SOAK");
    return text ? std::max(1, std::atoi(text)) : 1;
  }

  /// Flights along valleys and above, any attitude, every size.
  Tally fly(int views, unsigned seed, std::span<const DepthMapSize> sizes = kSizes) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> place(0.15, 0.85), unit(0, 1);
    Tally tally;
    for (int i = 0; i < views * soak(); ++i) {
      // 60 m to 9,000 m above the ground, most of them low, where much is hidden.
      const double above = 60 * std::pow(150.0, std::pow(unit(random), 2.5));
      const double pitch = i % 7 == 3 ? -75 + 30 * unit(random) : -20 + 25 * unit(random);
      const double roll = i % 3 == 0 ? 360 * unit(random) : 0;
      const auto east = place(random), north = place(random);
      auto r =
          request(over(east, north, above), {Degrees{360 * unit(random)}, Degrees{pitch}, Degrees{roll}});
      if (i % 5 == 4) r.view.left = -0.2, r.view.right = 0.9, r.view.bottom = -0.6, r.view.top = 0.1;
      r.lod.screenSpaceError = Pixels{i % 4 == 0 ? 6.0 : 2.0};
      compare(r, sizes[static_cast<std::size_t>(i) % sizes.size()], tally);
    }
    std::printf("%d views: %zu tiles by frustum, %zu proposed, %d views leave out over a fifth\n",
                tally.views, tally.frustum, tally.proposed, tally.viewsOverFifth);
    return tally;
  }
};

TEST_F(Occlusion, leavesNoPixelOutOverSyntheticMountains) {
  use(test::syntheticMountains());
  const Tally tally = fly(36, 1);
  EXPECT_EQ(tally.differing, 0u);
  EXPECT_GT(tally.maps, 30);
  EXPECT_GT(tally.viewsOverFifth, 8) << "it hides hardly anything";
}

TEST_F(Occlusion, leavesNoPixelOutOverEverest) {
  TRIMTAB_NEEDS_SHARED("data/dem-srtm3-everest");
  use(bakeShared("dem-srtm3-everest"));
  ASSERT_TRUE(database);
  const Tally tally = fly(24, 2);
  EXPECT_EQ(tally.differing, 0u);
  EXPECT_GT(tally.viewsOverFifth, 8);
}

TEST_F(Occlusion, leavesNoPixelOutOverFuji) {
  TRIMTAB_NEEDS_SHARED("data/dem-osgearth-fuji");
  use(bakeShared("dem-osgearth-fuji"));
  ASSERT_TRUE(database);
  const Tally tally = fly(18, 3);
  EXPECT_EQ(tally.differing, 0u);
  EXPECT_GT(tally.viewsOverFifth, 2);
}

TEST_F(Occlusion, leavesNoPixelOutOverTheSample) {
  const test::ScratchDir dir;
  terrain::SampleOptions options;
  options.postM = 90;
  ASSERT_TRUE(terrain::writeSample(dir / "sample.tif", options));
  auto baked = terrain::openOrBake(dir / "sample.tif", dir / "cache", {});
  ASSERT_TRUE(baked) << toString(baked.findings());
  use(baked.value());
  const Tally tally = fly(18, 4);
  EXPECT_EQ(tally.differing, 0u);
  EXPECT_GT(tally.viewsOverFifth, 2);
}

// Without this, the tests above might pass because nothing can go wrong where they look.
TEST_F(Occlusion, losesPixelsWhenOccludersAreNotLowered) {
  use(test::syntheticMountains());
  renderer.plant({.loweringScale = 0});
  constexpr std::array<DepthMapSize, 2> kCoarse{{{16, 12}, {24, 18}}};
  EXPECT_GT(fly(24, 1, kCoarse).differing, 0u);
  renderer.plant({});
  EXPECT_EQ(fly(24, 1, kCoarse).differing, 0u);
}

TEST_F(Occlusion, saysWhyItIsNotUsed) {
  use(test::syntheticMountains());
  const auto note = [this](const GeodeticPosition& eye) {
    auto r = request(eye, {Degrees{270}, Degrees{-5}, Degrees{0}});
    r.decision.depthMap = DepthMapSize{320, 240};
    const auto result = renderer.draw(r, offscreen->framebuffer());
    EXPECT_EQ(result.depthMap.has_value(), result.note.empty());
    EXPECT_TRUE(result.note.empty() || result.visible.occluded == 0);
    return result.note;
  };
  EXPECT_EQ(note(over(0.5, 0.5, 300)), "");
  EXPECT_EQ(note(over(0.5, 0.5, -30)), "the eye is under the ground");
  EXPECT_EQ(note(over(0.5, 0.5, 0.2)), "the eye is too near the ground");
  auto beside = over(0.5, 0.5, 3000);
  beside.longitude = beside.longitude + Degrees{0.6};
  EXPECT_EQ(note(beside), "the eye is not over the terrain");
}

TEST_F(Occlusion, isSkippedWhereTheDecisionAsksForNone) {
  use(test::syntheticMountains());
  auto r = request(over(0.5, 0.5, 300), {});
  auto result = renderer.draw(r, offscreen->framebuffer());
  EXPECT_EQ(result.depthMapsDrawn, 0u);
  EXPECT_TRUE(std::isnan(result.cost.occlusion));
  EXPECT_EQ(renderer.readDepthMap().width, 0);
  r.decision.depthMap = DepthMapSize{320, 240};
  result = renderer.draw(r, offscreen->framebuffer());
  EXPECT_EQ(result.depthMapsDrawn, 1u);
  EXPECT_GT(result.cost.occlusion, 0);
  r.method = CullingCase::view_frustum;
  EXPECT_EQ(renderer.draw(r, offscreen->framebuffer()).depthMapsDrawn, 1u);
  EXPECT_EQ(renderer.readDepthMap().width, 0) << "an old map must not pass for this frame's";
}

TEST_F(Occlusion, showsItsDepthMapAsGreys) {
  use(test::syntheticMountains());
  auto r = request(over(0.5, 0.5, 400), {Degrees{20}, Degrees{-10}, Degrees{0}});
  r.decision.depthMap = DepthMapSize{320, 240};
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
