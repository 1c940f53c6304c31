#include <cmath>
#include <numbers>

#include "core/scene/gl/guard_band.h"
#include "patched_terrain.h"
#include "steep_roofs.h"
#include "tests/core/scene/scene_test.h"
#include "trimtab/frame/frame_result.h"

/// Tiles and patches that show only their backs are left out, and no picture tells.
namespace trimtab {
namespace {

constexpr int kTiles = 8, kPosts = kTiles * TerrainIndex::kTileCells + 1;
constexpr double kStep = 1.0 / 1200;
const GeodeticPosition kCorner{Degrees{46.2}, Degrees{7.4}, Metres{0}};

class BackFaces : public test::SceneTest {
 protected:
  void useTiles() {
    use(std::make_shared<const test::SyntheticTerrain>(kTiles, kStep, kCorner, test::steepRoofs));
  }
  void usePatches() {
    terrain::HeightGrid grid;
    grid.posts = {kCorner.longitude.value(), kCorner.latitude.value(), kStep, kStep, kPosts, kPosts};
    for (int row = 0; row < kPosts; ++row)
      for (int column = 0; column < kPosts; ++column)
        grid.heights.push_back(static_cast<float>(test::steepRoofs(column, row)));
    use(std::make_shared<const test::PatchedTerrain>(std::move(grid), nullptr));
  }

  struct Seen {
    std::size_t leftOut = 0, differing = 0;
    std::size_t slivers =
        0;  ///< pixels that GL's own face culling changes: edges rounded to parts of a pixel
  };
  /// The same view with the switch on and off and without culling.
  void look(const GeodeticPosition& eye, const Attitude& attitude, CullingCase method, Seen& seen) {
    auto r = request(eye, attitude);
    r.terrain.form = database->patches() ? TerrainForm::patches : TerrainForm::tiles;
    r.levers.drawn.errorPx = 4;
    r.waitForPages = r.reproducible = true;
    r.levers.drawn.occlusion = OcclusionResolution{320, 240};
    r.cullingCase = method;
    FrameResult on, off;
    const auto fronts = picture(r, &on);
    r.cullingCase = CullingCase::none;
    const auto all = picture(r);
    r.backFaces = false;
    const auto bothOfAll = picture(r);
    r.cullingCase = method;
    const auto both = picture(r, &off);
    EXPECT_EQ(off.visible.backFacing, 0u);
    EXPECT_EQ(on.visible.tiles.size() + on.visible.outsideFrustum + on.visible.occluded +
                  on.visible.beyondVisibility + on.visible.backFacing,
              on.tilesInCut);
    seen.leftOut += on.visible.backFacing;
    seen.differing += differing(fronts, all) + differing(both, bothOfAll);
    seen.slivers += differing(all, bothOfAll);
  }
  void flyOver(CullingCase method, Seen& seen) {
    for (int i = 0; i < 60; ++i) {
      const double east = 0.12 + 0.76 * (i % 6) / 5, north = 0.15 + 0.7 * (i / 6) / 9;
      look(over(east, north,
                i % 3 == 0   ? 60
                : i % 3 == 1 ? 600
                             : 3000),
           {Degrees{i * 47.0}, Degrees{-4.0 - i % 5 * 6}, Degrees{i * 13.0}}, method, seen);
    }
  }
};

TEST_F(BackFaces, ofTilesAreLeftOutWhereNoPictureTells) {
  useTiles();
  Seen frustum, proposed;
  flyOver(CullingCase::view_frustum, frustum);
  flyOver(CullingCase::proposed, proposed);
  EXPECT_EQ(frustum.differing + proposed.differing, 0u);
  EXPECT_LT(frustum.slivers, 30u);
  EXPECT_GT(frustum.leftOut, 24u) << "nothing was left out, so nothing was tested";
}

TEST_F(BackFaces, ofPatchesAreLeftOutWhereNoPictureTells) {
  usePatches();
  Seen seen;
  flyOver(CullingCase::view_frustum, seen);
  EXPECT_EQ(seen.differing, 0u);
  EXPECT_LT(seen.slivers, 30u);
  EXPECT_GT(seen.leftOut, 10u) << "nothing was left out, so nothing was tested";
}

TEST_F(BackFaces, areDrawnForAnEyeBeyondTheDataOrBelowTheGround) {
  for (const bool patches : {false, true}) {
    patches ? usePatches() : useTiles();
    Seen seen;
    for (int i = 0; i < 8; ++i) {
      // From beyond an edge one sees the backs of what slopes away from it, and under the ground there.
      GeodeticPosition beyond = scene::placeIn(database->info(), i % 2 ? -0.2 : 1.15, 0.1 + 0.1 * i);
      beyond.height = Metres{-300.0 + 900 * i};
      look(beyond, {Degrees{i % 2 ? 90.0 : 270.0}, Degrees{-3}, Degrees{0}}, CullingCase::proposed, seen);
      look(over(0.2 + 0.08 * i, 0.5, -150.0 - 100 * i), {Degrees{i * 45.0}, Degrees{10}, Degrees{5}},
           CullingCase::proposed, seen);
    }
    EXPECT_EQ(seen.leftOut, 0u);
    EXPECT_EQ(seen.differing + seen.slivers, 0u);
  }
}

TEST(GuardBand, isAsWideAsViewportsAllow) {
  const auto times = [](int width, int height, const scene::ViewportLimits& limits) {
    ViewShape view;
    view.widthPx = width, view.heightPx = height;
    return scene::guardBandOf(view, limits);
  };
  EXPECT_EQ(times(1280, 720, {16384, 16384, true}), 4);
  EXPECT_EQ(times(4096, 4096, {16384, 16384, true}), 4);
  EXPECT_EQ(times(4098, 2000, {16384, 16384, true}), 2);
  EXPECT_EQ(times(2000, 8194, {16384, 16384, true}), 1);
  EXPECT_EQ(times(1281, 720, {16384, 16384, true}), 4);
  EXPECT_EQ(times(1281, 720, {16384, 16384, false}), 1);
  EXPECT_EQ(times(1280, 721, {16384, 16384, false}), 1);
  EXPECT_EQ(times(1280, 720, {16384, 16384, false}), 4);
  EXPECT_EQ(times(1280, 720, {}), 1);
}

TEST_F(BackFaces, openNoRidgeWhereGlCutsTriangles) {
  TRIMTAB_NEEDS_SHARED("data/dem-srtm3-everest");
  ASSERT_TRUE(useShared("dem-srtm3-everest"));
  // A sliver beside the picture's left edge; judged unrounded, it faces away (guard_band.h).
  auto r = request({Degrees{27.526951337}, Degrees{86.273159672}, Metres{2612.9352}},
                   {Degrees{151.820795}, Degrees{-4}, Degrees{0}});
  r.levers.drawn.errorPx = 0.5;
  r.cullingCase = CullingCase::none;
  const auto fronts = picture(r);
  r.backFaces = false;
  EXPECT_EQ(differing(fronts, picture(r)), 0u);
}

}  // namespace
}  // namespace trimtab
