#include <cmath>
#include <cstdlib>
#include <random>

#include "patched_terrain.h"
#include "tests/core/scene/culling/node_owners.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/frame/frame_result.h"

namespace trimtab {
namespace {

class PatchForm : public test::NodeOwners {
 protected:
  FrameRequest patches(double east, double north, double aboveM, const Attitude& attitude) const {
    auto r = request(over(east, north, aboveM), attitude);
    r.terrain.form = TerrainForm::patches;
    r.waitForPages = true;
    r.levers.drawn.occlusion = OcclusionResolution{320, 240};
    return r;
  }
  /// Views of all kinds: near the ground and high, level and steep, rolled.
  FrameRequest anyView(std::mt19937& random) const {
    std::uniform_real_distribution<double> place(0.15, 0.85), unit(0, 1);
    auto r =
        patches(place(random), place(random), 20 * std::pow(200, unit(random)),
                {Degrees{360 * unit(random)}, Degrees{20 - 90 * unit(random)}, Degrees{360 * unit(random)}});
    r.levers.drawn.errorPx = 0.5 * std::pow(16, unit(random));
    return r;
  }
  /// For people to look at: where TRIMTAB_PICTURES says.
  void keep(const std::string& name, const std::vector<std::uint8_t>& rgba, const ViewShape& view) const {
    const char* folder = std::getenv("TRIMTAB_PICTURES");
    if (folder == nullptr) return;
    const auto file = std::filesystem::path(folder) / (name + ".png");
    ASSERT_TRUE(scene::writePng(file, rgba, view.widthPx, view.heightPx));
  }
};

TEST_F(PatchForm, isDrawnWhereItIsAskedForOrThereIsNothingElse) {
  use(test::patchedMountains(true));
  auto r = patches(0.4, 0.5, 400, {Degrees{40}, Degrees{-10}, Degrees{}});
  FrameResult result;
  const auto byPatches = picture(r, &result);
  keep("patches", byPatches, r.view);
  EXPECT_TRUE(result.patches);
  EXPECT_FALSE(result.visible.tiles.empty());
  EXPECT_EQ(result.visible.reason.size(), result.tilesInCut);
  EXPECT_GE(result.tilesInCut, result.visible.tiles.size());
  r.terrain.form = TerrainForm::tiles;
  const auto byTiles = picture(r, &result);
  keep("tiles", byTiles, r.view);
  EXPECT_FALSE(result.patches);
  EXPECT_GT(differing(byPatches, byTiles), 1000u);
  r.terrain.form = TerrainForm::patches;
  EXPECT_EQ(differing(picture(r), byPatches), 0u) << "and back";

  use(test::patchedMountains(false));
  for (const TerrainForm form : {TerrainForm::tiles, TerrainForm::patches, TerrainForm::static_trees}) {
    r.terrain.form = form;
    EXPECT_EQ(differing(picture(r, &result), byPatches), 0u);
    EXPECT_TRUE(result.patches);
  }
}

/// Sea and land by turns, post by post, all round the earth: a quarter turn east of the middle it looks as it
/// does as far west.
TEST_F(PatchForm, hasItsFineGroundUnderTheEyeOnTerrainWiderThanHalfTheEarth) {
  terrain::HeightGrid grid;
  grid.posts = {-180, -2, 0.125, 0.125, 2881, 33};
  for (std::uint32_t row = 0; row < grid.posts.rows; ++row)
    for (std::uint32_t column = 0; column < grid.posts.columns; ++column)
      grid.heights.push_back((row + column) % 2 ? 2000.0f : 0.0f);
  use(std::make_shared<test::PatchedTerrain>(std::move(grid)));
  // Of blue to red, which the sun, elsewhere in the sky, leaves as it is.
  const auto contrast = [&](double longitude) {
    auto r = request({Degrees{0}, Degrees{longitude}, Metres{30000}}, {Degrees{}, Degrees{-90}, Degrees{}});
    r.terrain.form = TerrainForm::patches;
    const auto rgba = picture(r);
    keep("wide" + std::to_string(static_cast<int>(longitude)), rgba, r.view);
    double sum = 0, squares = 0;
    for (std::size_t i = 0; i < rgba.size(); i += 4) {
      const double ratio = rgba[i + 2] / std::max(1.0, static_cast<double>(rgba[i]));
      sum += ratio;
      squares += ratio * ratio;
    }
    const double count = static_cast<double>(rgba.size()) / 4;
    return std::sqrt(squares / count - sum / count * sum / count);
  };
  EXPECT_GT(contrast(-90), 0.03) << "posts can be told apart";
  EXPECT_GT(contrast(90), 0.03) << "0.01 from coarser levels";
}

TEST_F(PatchForm, isTheSameSurfaceAsTheTiles) {
  use(test::patchedMountains(true));
  std::mt19937 random(3);
  for (int i = 0; i < 6; ++i) {
    auto r = anyView(random);
    // Far enough for what the finest patches may err by.
    r.eye.height = Metres{2000.0 + 500 * i};
    r.levers.drawn.errorPx = 0.01;
    picture(r);
    const auto byPatches = renderer.readDistances();
    r.terrain.form = TerrainForm::tiles;
    picture(r);
    const auto byTiles = renderer.readDistances();
    std::size_t off = 0;
    for (std::size_t p = 0; p < byTiles.size(); ++p)
      off += std::isinf(byTiles[p]) != std::isinf(byPatches[p]) ||
             std::abs(byTiles[p] - byPatches[p]) > 0.05f * byTiles[p];
    EXPECT_LT(off, byTiles.size() / 100) << "view " << i;
  }
}

TEST_F(PatchForm, cullingCasesDrawTheSamePicture) {
  use(test::patchedMountains(false));
  std::mt19937 random(5);
  std::size_t hidden = 0, outside = 0;
  for (int i = 0; i < 24; ++i) {
    auto r = anyView(random);
    // Many small patches, from low: some are hidden.
    if (i % 2 == 0) {
      r.levers.drawn.errorPx = 0.05;
      r.eye = over(0.2 + 0.025 * i, 0.6, 60);
      r.attitude.pitch = Degrees{-3};
    }
    if (i % 3 == 0)
      r.decision.weather = {.fogged = true, .visibilityM = 9000, .extinctionPerM = 4e-4, .farM = 9000};
    r.levers.drawn.farM = r.decision.weather.farM;
    FrameResult result;
    r.cullingCase = CullingCase::none;
    const auto whole = picture(r, &result);
    EXPECT_EQ(result.visible.tiles.size(), result.tilesInCut);
    for (const CullingCase method : {CullingCase::view_frustum, CullingCase::proposed}) {
      r.cullingCase = method;
      EXPECT_EQ(differing(picture(r, &result), whole), 0u) << "view " << i;
      hidden += result.visible.occluded;
      outside += result.visible.outsideFrustum;
    }
  }
  EXPECT_GT(outside, 100u);
  EXPECT_GT(hidden, 20u);
}

TEST_F(PatchForm, nodePassGivesEachPixelToThePatchWithoutWhichItChanges) {
  use(test::patchedMountains(false));
  auto r = patches(0.4, 0.5, 150, {Degrees{40}, Degrees{-6}, Degrees{17}});
  r.cullingCase = CullingCase::view_frustum;
  for (const double error : {1.0, 8.0}) {
    r.levers.drawn.errorPx = error;
    compareWithLeavingOut(r, 16);
  }
}

TEST_F(PatchForm, nodePassWithoutCullingIsThePictureWithoutCulling) {
  use(test::patchedMountains(false));
  std::mt19937 random(7);
  for (int i = 0; i < 8; ++i) {
    auto r = anyView(random);
    picture(r);
    const auto unculled = renderer.readNodes(true);
    r.cullingCase = CullingCase::none;
    picture(r);
    EXPECT_EQ(unculled, renderer.readNodes()) << "view " << i;
  }
}

TEST_F(PatchForm, overlaysShowIt) {
  use(test::patchedMountains(false));
  auto r = patches(0.4, 0.5, 700, {Degrees{40}, Degrees{-20}, Degrees{}});
  const auto plain = picture(r);
  const auto changed = [&](const std::string& name, const Overlays& overlays) {
    auto with = r;
    with.overlays = overlays;
    const auto drawn = picture(with);
    keep("overlay-" + name, drawn, r.view);
    return differing(drawn, plain);
  };
  const std::size_t pixels = plain.size() / 4;
  EXPECT_GT(changed("wireframe", {.wireframe = true}), pixels / 20);
  EXPECT_GT(changed("bounds", {.tileBounds = true}), pixels / 100);
  EXPECT_GT(changed("level", {.colourByLevel = true}), pixels / 2);
  EXPECT_GT(changed("reason", {.colourByReason = true}), pixels / 2);
  EXPECT_GT(changed("holes", {.showHoles = true}), pixels / 50);
  EXPECT_EQ(differing(picture(r), plain), 0u);
  // Frozen, the cut and what is culled are those of the frozen eye.
  FrameResult here, frozen;
  picture(r, &here);
  const LocalFrame& frame = database->index().frame;
  auto moved = r;
  moved.frozenEye = EyePose{frame.fromGeodetic(r.eye), eyeAxes(frame, r.eye, r.attitude)};
  moved.eye = over(0.6, 0.6, 3000);
  keep("frozen", picture(moved, &frozen), r.view);
  ASSERT_EQ(frozen.visible.tiles.size(), here.visible.tiles.size());
}

TEST_F(PatchForm, whatIsColouredByTheGroundKeepsItsColourWhateverTheLevel) {
  use(test::patchedMountains(false));
  auto r = patches(0.5, 0.5, 6000, {Degrees{40}, Degrees{-80}, Degrees{}});
  r.levers.drawn.errorPx = 0.2;
  const auto fine = picture(r);
  keep("fine", fine, r.view);
  r.levers.drawn.errorPx = 2;
  const auto coarse = picture(r);
  keep("coarse", coarse, r.view);
  std::size_t off = 0;
  for (std::size_t i = 0; i < fine.size(); ++i) off += std::abs(int{fine[i]} - int{coarse[i]}) > 24;
  EXPECT_LT(off, fine.size() / 100);
}

}  // namespace
}  // namespace trimtab
