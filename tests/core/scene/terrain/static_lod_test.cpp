#include <cmath>
#include <random>
#include <set>

#include "synthetic_trees.h"
#include "tests/core/scene/scene_test.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/frame/frame_result.h"

namespace trimtab {
namespace {

using test::SceneTest;
using Pixel = std::array<int, 3>;

/// 16 x 16 trees of 5 levels each over 46 km of mountains.
std::shared_ptr<const test::TreeTerrain> treeMountains() {
  static const auto terrain = std::make_shared<const test::TreeTerrain>(test::syntheticMountains());
  return terrain;
}

class StaticTrees : public SceneTest {
 protected:
  FrameRequest treeRequest(const GeodeticPosition& eye, const Attitude& attitude) const {
    auto r = request(eye, attitude);
    r.terrain.form = TerrainForm::static_trees;
    return r;
  }
  static Pixel pixelAt(const std::vector<std::uint8_t>& rgba, int x, int y) {
    const std::size_t i = 4 * (static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x));
    return {rgba[i], rgba[i + 1], rgba[i + 2]};
  }
  static std::size_t magenta(const std::vector<std::uint8_t>& rgba) {
    std::size_t n = 0;
    for (std::size_t i = 0; i < rgba.size(); i += 4)
      n += rgba[i] == 255 && rgba[i + 1] == 0 && rgba[i + 2] == 255;
    return n;
  }
  const StaticLodIndex& trees() const { return database->staticLod()->index; }

  /// Views from low and high, any attitude; each culling case must draw the picture of the case *none*.
  void compareCases(int views, unsigned seed, double finestPx) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> place(0.15, 0.85), unit(0, 1);
    std::size_t outside = 0, hidden = 0;
    std::set<std::uint8_t> depths;
    for (int i = 0; i < views; ++i) {
      // Most of them low, where much is hidden.
      const double above = 40 * std::pow(200.0, std::pow(unit(random), 2.5));
      const double pitch = i % 5 == 3 ? -70 + 30 * unit(random) : -20 + 25 * unit(random);
      const auto east = place(random), north = place(random);
      auto r = treeRequest(over(east, north, above), {Degrees{360 * unit(random)}, Degrees{pitch},
                                                      Degrees{i % 3 ? 0 : 360 * unit(random)}});
      if (i % 6 == 5) r.view.left = -0.2, r.view.right = 0.9, r.view.bottom = -0.6, r.view.top = 0.1;
      r.levers.drawn.treeErrorPx = i % 4 ? finestPx : 16 * finestPx;
      r.levers.drawn.occlusion = OcclusionResolution{i % 4 < 2 ? 320 : 800, i % 4 < 2 ? 240 : 600};
      FrameResult result;
      r.cullingCase = CullingCase::none;
      const auto whole = picture(r, &result);
      for (const TileDraw& node : result.visible.tiles) depths.insert(trees().nodes[node.node].depth);
      r.cullingCase = CullingCase::view_frustum;
      EXPECT_EQ(differing(whole, picture(r, &result)), 0u) << "view " << i << ", frustum";
      outside += result.visible.outsideFrustum;
      r.cullingCase = CullingCase::proposed;
      EXPECT_EQ(differing(whole, picture(r, &result)), 0u) << "view " << i << ", proposed";
      hidden += result.visible.occluded;
    }
    EXPECT_GT(outside, static_cast<std::size_t>(views) * 20);
    EXPECT_GT(hidden, static_cast<std::size_t>(views)) << "it hides hardly anything";
    EXPECT_GE(depths.size(), 4u) << "levels hardly changed";
    std::printf("%d views: %zu nodes outside the frustum, %zu hidden\n", views, outside, hidden);
  }

  /// Looks down from several heights at several errors.
  void lookForHoles() {
    std::set<std::uint8_t> depths;
    for (const double above : {90.0, 300.0, 1000.0, 2500.0, 5000.0})
      for (const double error : {0.2, 1.0, 4.0, 16.0}) {
        auto r = treeRequest(over(0.48 + above * 1e-5, 0.52, above),
                             {Degrees{above}, Degrees{-90 + above / 200}, Degrees{error}});
        r.overlays.showHoles = true;
        r.levers.drawn.treeErrorPx = error;
        FrameResult result;
        EXPECT_EQ(magenta(picture(r, &result)), 0u) << above << " m, " << error << " px";
        for (const TileDraw& node : result.visible.tiles) depths.insert(trees().nodes[node.node].depth);
      }
    EXPECT_GE(depths.size(), 3u) << "levels hardly changed, so their borders were not looked at";
  }
};

TEST_F(StaticTrees, drawTheSameTerrainAsTheTiledLevelsWhereBothAreExact) {
  use(std::make_shared<const test::TreeTerrain>(std::make_shared<const test::SyntheticTerrain>(
      4, 1.0 / 1200, GeodeticPosition{Degrees{36.4}, Degrees{128.1}, Metres{0}}, test::mountains)));
  for (const double heading : {0.0, 130.0, 260.0}) {
    auto r = treeRequest(over(0.5, 0.45, 250), {Degrees{heading}, Degrees{-6}, Degrees{heading / 20}});
    r.levers.drawn.errorPx = 1e-6;
    r.levers.drawn.treeErrorPx = 1e-6;
    const auto byTrees = picture(r);
    r.terrain.form = TerrainForm::tiles;
    const auto byLevels = picture(r);
    // Where the noise on the ground is counted from differs from tile to tile: a step or two of 255.
    std::size_t apart = 0, different = 0;
    for (std::size_t i = 0; i < byTrees.size(); ++i) {
      apart += std::abs(byTrees[i] - byLevels[i]) > 2;
      different += byTrees[i] != byLevels[i];
    }
    // One pixel of a sliver that faces away: the tiled levels leave such triangles out, scenery has no sides.
    EXPECT_LE(apart, 3u) << heading << "; " << different << " of " << byTrees.size();
  }
}

TEST_F(StaticTrees, cullingNeverChangesAPixel) {
  use(treeMountains());
  compareCases(24, 5, 0.05);
}

TEST_F(StaticTrees, leaveNoHoleBetweenNodesAndTilesOfAnyLevels) {
  use(treeMountains());
  lookForHoles();
}

TEST_F(StaticTrees, cullingNeverChangesAPixelOverKansai) {
  TRIMTAB_NEEDS_SHARED("data/fg-kansai-e135n35");
  use(bakeShared("fg-kansai-e135n35"));
  ASSERT_TRUE(database);
  ASSERT_TRUE(database->staticLod());
  compareCases(48, 6, 0.05);
}

TEST_F(StaticTrees, leaveNoHoleInKansai) {
  TRIMTAB_NEEDS_SHARED("data/fg-kansai-e135n35");
  use(bakeShared("fg-kansai-e135n35"));
  ASSERT_TRUE(database);
  lookForHoles();
}

TEST_F(StaticTrees, holdTheirPlaceHundredKilometresFromTheOrigin) {
  const auto spike = [](int c, int r) { return c == 61 && r == 63 ? 20.0 : 0.0; };
  const auto plain = std::make_shared<const test::SyntheticTerrain>(
      4, 0.0001, GeodeticPosition{Degrees{35}, Degrees{127}, Metres{0}}, spike, Degrees{0.9});
  use(std::make_shared<const test::TreeTerrain>(plain));
  ASSERT_GT(length(plain->post(61, 63)), 100e3);
  const GeodeticPosition top = database->index().frame.toGeodetic(plain->post(61, 63));
  std::size_t seen = 0;
  for (int i = 0; i < 24; ++i) {
    // Past the spike in steps that are no round numbers; the tiled picture is held against a projection in
    // doubles by a test of its own.
    const double away = 0.00018 + 0.0000171 * i;
    auto r = treeRequest({top.latitude - Degrees{away}, top.longitude + Degrees{0.0000043 * i}, Metres{1.37}},
                         {Degrees{-3 + 0.271 * i}, Degrees{0}, Degrees{0}});
    r.overlays.showHoles = true;
    r.levers.drawn.treeErrorPx = 1e-6;
    const auto byTrees = picture(r);
    r.terrain.form = TerrainForm::tiles;
    r.levers.drawn.errorPx = 1e-6;
    const auto byLevels = picture(r);
    std::size_t wrong = 0;
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const bool a = pixelAt(byTrees, x, y) == Pixel{255, 0, 255},
                   b = pixelAt(byLevels, x, y) == Pixel{255, 0, 255};
        wrong += a != b;
        seen += !b && y > kHeight / 2 + 10;
      }
    EXPECT_EQ(wrong, 0u) << "step " << i;
  }
  EXPECT_GT(seen, 10000u) << "the spike was hardly seen";
}

TEST_F(StaticTrees, areCoarserFartherAwayAndForALargerScale) {
  use(treeMountains());
  std::uint64_t last = ~0ull;
  for (const double above : {200.0, 2000.0, 8000.0, 40000.0}) {
    auto r = treeRequest(over(0.5, 0.5, above), {Degrees{0}, Degrees{-90}, Degrees{0}});
    r.cullingCase = CullingCase::none;
    const auto result = renderer.draw(r, offscreen->framebuffer());
    EXPECT_LT(result.visible.triangles, last);
    last = result.visible.triangles;
  }
  auto r = treeRequest(over(0.5, 0.5, 2000), {Degrees{0}, Degrees{-20}, Degrees{0}});
  const auto fine = renderer.draw(r, offscreen->framebuffer());
  r.levers.drawn.lodScale = 4;
  const auto coarse = renderer.draw(r, offscreen->framebuffer());
  EXPECT_LT(coarse.visible.triangles, fine.visible.triangles);
  r.levers.drawn.lodScale = 1;
  r.staticLod.rule = StaticDistanceRule::factor;
  r.staticLod.distancePerError = Ratio{50};
  const auto byFactor = renderer.draw(r, offscreen->framebuffer());
  r.staticLod.distancePerError = Ratio{2000};
  EXPECT_LT(byFactor.visible.triangles, renderer.draw(r, offscreen->framebuffer()).visible.triangles);
}

TEST_F(StaticTrees, fillTheCountsThatPlotsAndTracesRead) {
  use(treeMountains());
  auto r = treeRequest(over(0.5, 0.5, 500), {Degrees{40}, Degrees{-10}, Degrees{0}});
  const auto result = renderer.draw(r, offscreen->framebuffer());
  ASSERT_TRUE(result.staticLod.drawn);
  std::uint64_t triangles = 0, byDepth = 0, vertices = 0;
  const auto& terrain = *database->staticLod();
  for (const TileDraw& node : result.visible.tiles) {
    triangles += terrain.ranges[node.node].triangles;
    const auto& indices = terrain.tiles[trees().nodes[node.node].tile].indices;
    const auto first = indices.begin() + terrain.ranges[node.node].firstTriangle * 3;
    vertices += std::set<std::uint32_t>(first, first + terrain.ranges[node.node].triangles * 3).size();
  }
  for (const std::uint64_t n : result.staticLod.triangles) byDepth += n;
  EXPECT_EQ(result.visible.triangles, triangles);
  EXPECT_EQ(result.visible.vertices, vertices);
  EXPECT_EQ(byDepth, triangles);
  EXPECT_EQ(result.visible.tiles.size() + result.visible.outsideFrustum + result.visible.occluded,
            result.tilesInCut);
  EXPECT_EQ(result.visible.reason.size(), result.tilesInCut);
  r.terrain.form = TerrainForm::tiles;
  const auto levels = renderer.draw(r, offscreen->framebuffer());
  EXPECT_FALSE(levels.staticLod.drawn);
  EXPECT_EQ(levels.visible.reason.size(), levels.tilesInCut);
}

TEST_F(StaticTrees, areUploadedAheadForAComingImage) {
  use(treeMountains());
  auto r = treeRequest(over(0.5, 0.5, 300), {Degrees{0}, Degrees{-5}, Degrees{0}});
  const auto first = renderer.draw(r, offscreen->framebuffer());
  EXPECT_GT(renderer.buildAhead(trees().roots, 0).left, 0u);
  EXPECT_GT(renderer.buildAhead(trees().roots, 1e9).built, 0u);
  EXPECT_EQ(renderer.buildAhead(trees().roots, 0).left, 0u);
  r.attitude.heading = Degrees{180};
  EXPECT_EQ(renderer.draw(r, offscreen->framebuffer()).counters.tilesBuilt, first.counters.tilesBuilt);
}

TEST_F(StaticTrees, areUploadedOnFirstUseAndSelectedOnlyAnew) {
  use(treeMountains());
  auto r = treeRequest(over(0.5, 0.5, 300), {Degrees{0}, Degrees{-5}, Degrees{0}});
  const auto first = renderer.draw(r, offscreen->framebuffer());
  EXPECT_GT(first.counters.tilesBuilt, 0u);
  EXPECT_LT(first.counters.tilesBuilt, trees().roots.size()) << "tiles out of sight were uploaded";
  EXPECT_EQ(first.counters.cutsSelected, 1u);
  EXPECT_EQ(renderer.draw(r, offscreen->framebuffer()).counters.tilesBuilt, first.counters.tilesBuilt);
  r.attitude.heading = Degrees{180};  // only the head turns
  const auto turned = renderer.draw(r, offscreen->framebuffer());
  EXPECT_EQ(turned.counters.cutsSelected, 1u);
  EXPECT_GT(turned.counters.tilesBuilt, first.counters.tilesBuilt);
  r.levers.drawn.lodScale = 2;
  EXPECT_EQ(renderer.draw(r, offscreen->framebuffer()).counters.cutsSelected, 2u);
  r.eye.height = r.eye.height + Metres{1};
  EXPECT_EQ(renderer.draw(r, offscreen->framebuffer()).counters.cutsSelected, 3u);
  renderer.setTerrain(database);
  EXPECT_EQ(renderer.draw(r, offscreen->framebuffer()).counters.cutsSelected, 4u);
}

TEST_F(StaticTrees, drawTheSamePictureAfterARelease) {
  use(treeMountains());
  auto r = treeRequest(over(0.4, 0.4, 400), {Degrees{30}, Degrees{-8}, Degrees{10}});
  const auto first = picture(r);
  renderer.release();
  ASSERT_TRUE(renderer.initialize().usable);
  EXPECT_EQ(differing(first, picture(r)), 0u);
}

TEST_F(StaticTrees, areLeftOutWhereTheTerrainHasNone) {
  use(test::syntheticMountains());
  auto r = request(over(0.4, 0.4, 400), {Degrees{30}, Degrees{-8}, Degrees{0}});
  const auto plain = picture(r);
  r.terrain.form = TerrainForm::static_trees;
  r.overlays.treeDepth = 2;
  r.overlays.treePicture = true;
  FrameResult result;
  EXPECT_EQ(differing(plain, picture(r, &result)), 0u);
  EXPECT_FALSE(result.staticLod.drawn);
}

TEST_F(StaticTrees, showEachLevelByItself) {
  use(treeMountains());
  auto r = request(over(0.5, 0.5, 12000), {Degrees{0}, Degrees{-90}, Degrees{0}});
  r.cullingCase = CullingCase::none;
  std::uint64_t last = 0;
  for (int depth = 0; depth < 5; ++depth) {
    r.overlays.treeDepth = depth;
    const auto result = renderer.draw(r, offscreen->framebuffer());
    ASSERT_TRUE(result.staticLod.drawn) << "an overlay draws the trees whatever the preset says";
    for (const TileDraw& node : result.visible.tiles) EXPECT_EQ(trees().nodes[node.node].depth, depth);
    EXPECT_EQ(result.visible.tiles.size(), trees().roots.size() << depth);
    EXPECT_GT(result.visible.triangles, last);
    last = result.visible.triangles;
  }
}

TEST_F(StaticTrees, showDocumentEsPictureInGreyRedAndBlack) {
  use(treeMountains());
  const test::SyntheticTerrain& ground = treeMountains()->surface();
  // Over the common corner of four tiles.
  const LocalFrame& frame = database->index().frame;
  GeodeticPosition eye = frame.toGeodetic(ground.post(256, 256));
  eye.height = eye.height + Metres{2500};
  auto r = request(eye, {Degrees{0}, Degrees{-90}, Degrees{0}});
  r.overlays.treePicture = true;
  for (const int depth : {0, 2, 4}) {
    r.overlays.treeDepth = depth;
    const auto rgba = picture(r);
    std::size_t grey = 0, red = 0, black = 0, other = 0;
    for (std::size_t i = 0; i < rgba.size(); i += 4) {
      const int a = rgba[i], b = rgba[i + 1], c = rgba[i + 2];
      if (a == b && b == c && a > 200)
        ++grey;
      else if (a > 200 && b == 0 && c == 0)
        ++red;
      else if (a == 0 && b == 0 && c == 0)
        ++black;
      else
        ++other;
    }
    EXPECT_EQ(other, 0u);
    EXPECT_GT(grey, rgba.size() / 4 / 3);
    EXPECT_GT(red, 1000u);
    EXPECT_GT(black, 500u);
    const auto near = [&](Vec3 p, Pixel colour) {
      const auto [x, y] = projected(r, frame, p);
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx)
          if (pixelAt(rgba, x + dx, y + dy) == colour) return true;
      return false;
    };
    const auto between = [&](int x0, int y0, int x1, int y1) {
      return 0.5 * (ground.post(x0, y0) + ground.post(x1, y1));
    };
    // Between two tiles: locked at every level. Inside a leaf: free. Between two leaves: locked in the
    // leaves, gone where they are merged.
    for (int k = 1; k < 8; ++k)
      EXPECT_TRUE(near(between(256, 256 + k, 256, 257 + k), {0, 0, 0})) << depth << ", " << k;
    const bool leafBorder = near(between(264, 258, 264, 259), {0, 0, 0});
    EXPECT_EQ(leafBorder, depth == 4) << depth;
    for (int k = 1; depth == 4 && k < 7; ++k)
      EXPECT_TRUE(near(between(257 + k, 258, 257 + k, 259), {217, 0, 0})) << k;
  }
}

TEST_F(StaticTrees, workWithEveryOtherOverlay) {
  use(treeMountains());
  paintEachOverlay(treeRequest(over(0.5, 0.5, 600), {Degrees{40}, Degrees{-15}, Degrees{0}}));
}

TEST_F(StaticTrees, keepWhatWasHiddenWhileCullingIsFrozen) {
  use(treeMountains());
  auto r = treeRequest(over(0.3, 0.3, 60), {Degrees{40}, Degrees{-3}, Degrees{0}});
  r.levers.drawn.treeErrorPx = 0.05;
  r.levers.drawn.occlusion = OcclusionResolution{320, 240};
  const auto live = renderer.draw(r, offscreen->framebuffer());
  ASSERT_GT(live.visible.occluded, 5u);
  const auto grey = renderer.readDepthMap();
  EXPECT_EQ(grey.width, 320);
  EXPECT_LT(grey.pixels[160], 200) << "the bottom row is near ground";
  EXPECT_EQ(grey.pixels[239 * 320 + 160], 255) << "the top row is sky";
  r.frozenEye = EyePose{database->index().frame.fromGeodetic(r.eye),
                        eyeAxes(database->index().frame, r.eye, r.attitude)};
  for (int i = 1; i < 4; ++i) {
    r.eye = over(0.3 - 0.05 * i, 0.3, 2000);
    const auto frozen = renderer.draw(r, offscreen->framebuffer());
    EXPECT_EQ(frozen.counters.cutsSelected, live.counters.cutsSelected);
    EXPECT_EQ(frozen.visible.reason, live.visible.reason);
    EXPECT_EQ(frozen.counters.depthMapsDrawn, live.counters.depthMapsDrawn);
    EXPECT_NE(frozen.note, "");
    EXPECT_EQ(renderer.readDepthMap().width, 0) << "an old map must not pass for this frame's";
  }
}

TEST_F(StaticTrees, chooseAndReadNothingAgainForAViewThatStands) {
  use(treeMountains());
  auto r = treeRequest(over(0.3, 0.3, 60), {Degrees{40}, Degrees{-3}, Degrees{0}});
  r.levers.drawn.treeErrorPx = 0.05;
  r.levers.drawn.occlusion = OcclusionResolution{320, 240};
  FrameResult first, second;
  const auto before = picture(r, &first);
  ASSERT_GT(first.visible.occluded, 5u);
  const auto grey = renderer.readDepthMap();
  const auto after = picture(r, &second);
  EXPECT_EQ(differing(before, after), 0u);
  EXPECT_EQ(second.counters.visibleSelected, first.counters.visibleSelected);
  EXPECT_EQ(second.counters.depthMapsDrawn, first.counters.depthMapsDrawn);
  EXPECT_EQ(second.visible.reason, first.visible.reason);
  EXPECT_EQ(second.note, "");
  EXPECT_TRUE(second.depthMap) << "it has its part in what is drawn";
  EXPECT_EQ(second.occlusion, OcclusionMethod::depth_map);
  EXPECT_EQ(renderer.readDepthMap().pixels, grey.pixels);
  r.skips.sameVisible = false;
  EXPECT_EQ(differing(before, picture(r, &second)), 0u);
  EXPECT_EQ(second.counters.visibleSelected, first.counters.visibleSelected + 1);
  EXPECT_EQ(second.counters.depthMapsDrawn, first.counters.depthMapsDrawn + 1);
  r.skips.sameVisible = true;
  const auto changes = [&](const char* what, const auto& change) {
    auto other = r;
    change(other);
    FrameResult result;
    picture(other, &result);
    EXPECT_EQ(result.counters.visibleSelected, second.counters.visibleSelected + 1) << what;
    second = result;
    picture(r, &second);
  };
  changes("a head that turns", [](auto& c) { c.attitude.heading = Degrees{41}; });
  changes("another case", [](auto& c) { c.cullingCase = CullingCase::view_frustum; });
  changes("another size of the map", [](auto& c) {
    c.levers.drawn.occlusion = OcclusionResolution{160, 120};
  });
  changes("coarser levels", [](auto& c) { c.levers.drawn.lodScale = 3; });
  changes("weather", [](auto& c) { c.levers.drawn.farM = 2000; });
}

TEST_F(StaticTrees, readNoDepthMapWhereNoneIsAskedForOrWorthIt) {
  use(treeMountains());
  auto r = treeRequest(over(0.3, 0.3, 60), {Degrees{40}, Degrees{-3}, Degrees{0}});
  r.levers.drawn.treeErrorPx = 0.05;
  auto result = renderer.draw(r, offscreen->framebuffer());
  EXPECT_EQ(result.counters.depthMapsDrawn, 0u) << "scheme frustum";
  EXPECT_TRUE(std::isnan(result.cost.occlusion));
  r.levers.drawn.occlusion = OcclusionResolution{320, 240};
  r.cullingCase = CullingCase::view_frustum;
  EXPECT_EQ(renderer.draw(r, offscreen->framebuffer()).counters.depthMapsDrawn, 0u);
  r.cullingCase = CullingCase::proposed;
  result = renderer.draw(r, offscreen->framebuffer());
  EXPECT_EQ(result.counters.depthMapsDrawn, 1u);
  EXPECT_GT(result.cost.occlusion, 0);
  r.eye = over(0.3, 0.3, 9000);
  r.attitude.pitch = Degrees{-50};
  result = renderer.draw(r, offscreen->framebuffer());
  EXPECT_EQ(result.counters.depthMapsDrawn, 1u) << "from so high nothing can be hidden";
  EXPECT_NE(result.note, "");
  r.staticLod.mapFromTriangles = Ratio{0};
  result = renderer.draw(r, offscreen->framebuffer());
  EXPECT_EQ(result.counters.depthMapsDrawn, 2u) << "asked for whatever it costs";
  EXPECT_EQ(result.note, "");
}

}  // namespace
}  // namespace trimtab
