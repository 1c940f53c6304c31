#include <set>

#include "scene_test.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/scene/renderer.h"
#include "trimtab/units/not_finite.h"

namespace trimtab {
namespace {

using test::SceneTest;

class Renderer : public SceneTest {
 protected:
  static std::size_t magenta(const std::vector<std::uint8_t>& rgba) {
    std::size_t n = 0;
    for (std::size_t i = 0; i < rgba.size(); i += 4)
      n += rgba[i] == 255 && rgba[i + 1] == 0 && rgba[i + 2] == 255;
    return n;
  }

  /// Looks down on the middle of the terrain from several heights, levels of detail and rolls.
  void lookForHoles() {
    std::set<int> levels;
    for (const double above : {90.0, 300.0, 1000.0, 2500.0, 5000.0})
      for (const double error : {1.0, 4.0, 16.0, 60.0}) {
        auto r = request(over(0.48 + above * 1e-5, 0.52, above),
                         {Degrees{above}, Degrees{-90 + above / 200}, Degrees{error}});
        r.overlays.showHoles = true;
        r.levers.drawn.errorPx = error;
        r.cullingCase = CullingCase::proposed;
        r.levers.drawn.occlusion = OcclusionResolution{320, 240};
        FrameResult result;
        EXPECT_EQ(magenta(picture(r, &result)), 0u) << above << " m, " << error << " px";
        for (const TileDraw& tile : result.visible.tiles) levels.insert(database->index().level[tile.node]);
      }
    EXPECT_GE(levels.size(), 3u) << "levels hardly changed, so their borders were not looked at";
  }
};

TEST_F(Renderer, leavesNoHoleOverSyntheticMountains) {
  use(test::syntheticMountains());
  lookForHoles();
}

TEST_F(Renderer, leavesNoHoleOverEverest) {
  TRIMTAB_NEEDS_SHARED("data/dem-srtm3-everest");
  use(bakeShared("dem-srtm3-everest"));
  ASSERT_TRUE(database);
  lookForHoles();
}

// A hole must be seen when there is one.
TEST_F(Renderer, showsHolesInMagenta) {
  use(test::syntheticMountains());
  auto r = request(over(0.5, 0.5, 500), {Degrees{0}, Degrees{60}, Degrees{0}});
  r.overlays.showHoles = true;
  EXPECT_EQ(magenta(picture(r)), std::size_t{kWidth} * kHeight) << "straight into the sky";
  r.overlays.showHoles = false;
  EXPECT_EQ(magenta(picture(r)), 0u);
}

TEST_F(Renderer, drawsTheSamePictureAgainAndAfterAReleaseToo) {
  use(test::syntheticMountains());
  auto r = request(over(0.4, 0.4, 400), {Degrees{30}, Degrees{-8}, Degrees{10}});
  const auto first = picture(r);
  EXPECT_EQ(differing(first, picture(r)), 0u);
  for (int i = 0; i < 2; ++i) {
    renderer.release();
    EXPECT_TRUE(renderer.draw(r, offscreen->framebuffer()).visible.tiles.empty()) << "nothing to draw with";
    ASSERT_TRUE(renderer.initialize().usable);
    EXPECT_EQ(differing(first, picture(r)), 0u);
  }
}

TEST_F(Renderer, drawsIntoTheFramebufferItIsGiven) {
  use(test::syntheticMountains());
  const auto r = request(over(0.4, 0.4, 400), {Degrees{30}, Degrees{-8}, Degrees{0}});
  const auto small = picture(r);
  auto larger = scene::Offscreen::create(kWidth, kHeight);
  ASSERT_TRUE(larger);
  scene::Renderer second;
  ASSERT_TRUE(second.initialize().usable);
  second.setTerrain(database);
  second.draw(r, larger.value()->framebuffer());
  EXPECT_EQ(differing(small, second.readPixels(kWidth, kHeight)), 0u)
      << "two renderers, two contexts, one process";
  second.release();
}

TEST_F(Renderer, buildsAheadWhatAComingImageDraws) {
  use(test::syntheticMountains());
  auto r = request(over(0.5, 0.5, 400), {});
  r.cullingCase = CullingCase::none;
  const auto first = renderer.draw(r, offscreen->framebuffer());
  r.attitude.heading = Degrees{120};
  r.levers.drawn = withBudget(r.levers.drawn, {8, 1, 1, 1});
  const auto expected = [&] {  // as another renderer, which built nothing ahead, draws it
    scene::Renderer other;
    EXPECT_TRUE(other.initialize().usable);
    other.setTerrain(database);
    const FrameResult drawn = other.draw(r, offscreen->framebuffer());
    const auto pixels = other.readPixels(kWidth, kHeight);
    other.release();
    return std::pair(drawn, pixels);
  }();
  std::vector<std::uint32_t> nodes;
  for (const TileDraw& tile : expected.first.visible.tiles) nodes.push_back(tile.node);
  const std::size_t missing = renderer.buildAhead(nodes, 0).left;
  EXPECT_GT(missing, 10u);
  EXPECT_EQ(renderer.buildAhead(nodes, kNan).built, 0u);
  const scene::BuiltAhead some = renderer.buildAhead(nodes, 1e-6);
  EXPECT_LT(some.built, missing) << "a nanosecond is over before all are built";
  EXPECT_EQ(some.built + some.left, missing);
  EXPECT_EQ(renderer.buildAhead(nodes, 1e9).left, 0u);
  EXPECT_EQ(renderer.buildAhead(nodes, 1e9).built, 0u) << "they are there already";
  const auto second = renderer.draw(r, offscreen->framebuffer());
  EXPECT_GT(second.counters.tilesBuiltAhead, 10u);
  EXPECT_EQ(second.counters.tilesBuilt, first.counters.tilesBuilt);
  EXPECT_EQ(differing(expected.second, renderer.readPixels(kWidth, kHeight)), 0u);
}

TEST_F(Renderer, doesNotRepeatWorkThatNothingAsksFor) {
  use(test::syntheticMountains());
  auto r = request(over(0.5, 0.5, 400), {});
  auto result = renderer.draw(r, offscreen->framebuffer());
  EXPECT_EQ(result.counters.cutsSelected, 1u);
  EXPECT_GT(result.counters.tilesBuilt, 0u);
  for (int i = 0; i < 5; ++i) {  // only the head turns
    r.attitude.heading = Degrees{20.0 * i};
    result = renderer.draw(r, offscreen->framebuffer());
  }
  EXPECT_EQ(result.counters.cutsSelected, 1u);
  const auto built = result.counters.tilesBuilt;
  result = renderer.draw(r, offscreen->framebuffer());
  EXPECT_EQ(result.counters.tilesBuilt, built);
  r.levers.drawn.errorPx = 3;
  EXPECT_EQ(renderer.draw(r, offscreen->framebuffer()).counters.cutsSelected, 2u);
  r.levers.drawn.lodScale = 2;
  EXPECT_EQ(renderer.draw(r, offscreen->framebuffer()).counters.cutsSelected, 3u);
  r.eye.height = r.eye.height + Metres{1};
  EXPECT_EQ(renderer.draw(r, offscreen->framebuffer()).counters.cutsSelected, 4u);
  renderer.setTerrain(database);
  EXPECT_EQ(renderer.draw(r, offscreen->framebuffer()).counters.cutsSelected, 5u);
}

TEST_F(Renderer, holdsCullingStillWhileFrozen) {
  use(test::syntheticMountains());
  auto r = request(over(0.5, 0.5, 300), {Degrees{40}, Degrees{-5}, Degrees{0}});
  r.levers.drawn.occlusion = OcclusionResolution{320, 240};
  const auto live = renderer.draw(r, offscreen->framebuffer());
  r.frozenEye = EyePose{database->index().frame.fromGeodetic(r.eye),
                        eyeAxes(database->index().frame, r.eye, r.attitude)};
  for (int i = 1; i < 4; ++i) {
    r.eye = over(0.5 - 0.05 * i, 0.5, 2000);
    const auto frozen = renderer.draw(r, offscreen->framebuffer());
    EXPECT_EQ(frozen.counters.cutsSelected, live.counters.cutsSelected);
    EXPECT_EQ(frozen.visible.reason, live.visible.reason);
  }
}

TEST_F(Renderer, paintsEachOverlay) {
  use(test::syntheticMountains());
  auto r = request(over(0.5, 0.5, 600), {Degrees{40}, Degrees{-15}, Degrees{0}});
  r.levers.drawn.occlusion = OcclusionResolution{320, 240};
  paintEachOverlay(r);
}

TEST_F(Renderer, readsDepthByReversedConvention) {
  // A plain at sea level: what the depth map shows in its middle is known.
  use(std::make_shared<const test::SyntheticTerrain>(
      16, 1.0 / 1200, GeodeticPosition{Degrees{10}, Degrees{20}, Metres{0}},
      [](int c, int r) { return 0.1 * ((c * 7 + r * 13) % 3); }));
  for (const double above : {400.0, 1000.0, 4000.0}) {
    auto r = request(over(0.5, 0.5, above), {Degrees{0}, Degrees{-45}, Degrees{0}});
    r.levers.drawn.occlusion = OcclusionResolution{641, 481};
    r.levers.drawn.errorPx = 0.001;
    ASSERT_TRUE(renderer.draw(r, offscreen->framebuffer()).depthMap.has_value());
    const auto grey = renderer.readDepthMap();
    const double expected = 254 * std::log(above * std::sqrt(2.0) / 50) / std::log(200e3 / 50);
    EXPECT_NEAR(grey.pixels[240 * 641 + 320], expected, 1.5) << above;
  }
}

TEST_F(Renderer, measuresItsStages) {
  use(test::syntheticMountains());
  auto r = request(over(0.5, 0.5, 400), {});
  r.levers.drawn.occlusion = OcclusionResolution{320, 240};
  FrameResult result;
  for (int i = 0; i < 6; ++i) result = renderer.draw(r, offscreen->framebuffer());
  const FrameCost& c = result.cost;
  for (const double stage : {c.select, c.occlusion, c.cull, c.draw, c.total}) EXPECT_GT(stage, 0);
  if (report.software)
    EXPECT_TRUE(std::isnan(c.gpu)) << "its time is in draw";
  else
    EXPECT_GT(c.gpu, 0);
  EXPECT_LE(c.select + c.occlusion + c.cull + c.draw, c.total * 1.001);
}

TEST(RendererWithoutAContext, saysWhatIsMissingAndDrawsNothing) {
  scene::Renderer renderer;
  const auto report = renderer.initialize();
  EXPECT_FALSE(report.usable);
  EXPECT_EQ(report.missing, "a current OpenGL context");
  EXPECT_TRUE(renderer.draw({}, 0).visible.tiles.empty());
  EXPECT_EQ(renderer.readDepthMap().width, 0);
}

TEST(Png, isWrittenWholeOrNotAtAll) {
  const test::ScratchDir dir;
  const std::vector<std::uint8_t> rgba(4 * 3 * 4, 200);
  ASSERT_TRUE(scene::writePng(dir / "a.png", rgba, 4, 3).ok());
  const std::string bytes = test::readFile(dir / "a.png");
  ASSERT_GT(bytes.size(), 33u);
  EXPECT_EQ(bytes.substr(0, 8), "\x89PNG\r\n\x1a\n");
  EXPECT_EQ(bytes.substr(16, 8), std::string("\0\0\0\4\0\0\0\3", 8)) << "width and height of IHDR";
  EXPECT_FALSE(scene::writePng(dir / "absent" / "a.png", rgba, 4, 3).ok());
  EXPECT_FALSE(scene::writePng(dir / "b.png", rgba, 40, 3).ok()) << "fewer bytes than pixels";
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(dir.path()), {}), 1);
}

}  // namespace
}  // namespace trimtab
