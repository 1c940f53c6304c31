#include <algorithm>
#include <cmath>

#include "../terrain/rasters.h"
#include "culling_truth.h"
#include "trimtab/terrain/import.h"

/// No tile that owns a pixel is ever left out: 25 views and as many frames of flight over each terrain, 1,000
/// with TRIMTAB_SOAK=40 and then in every band.
namespace trimtab {
namespace {

using test::CullingTruth;

class CullingViews : public CullingTruth {
 protected:
  void useShared(const char* folder) {
    use(bakeShared(folder));
    ASSERT_TRUE(database);
  }
  /// 401 x 401 posts around Everest, elsewhere on the earth, as wide there as they are here.
  void useEverestAt(double west, double south) {
    const auto file = test::sharedDir() / "data/dem-srtm3-everest/N27E086.hgt";
    const auto whole = terrain::readElevation(file, {});
    ASSERT_TRUE(whole) << toString(whole.findings());
    test::RasterRecipe recipe;
    recipe.columns = recipe.rows = 401;
    recipe.step = 1.0 / 1200;
    constexpr double kRadians = 3.14159265358979 / 180;
    const double middle = south + 200 * recipe.step;
    recipe.stepEast = recipe.step * std::cos(28 * kRadians) / std::cos(middle * kRadians);
    recipe.west = west, recipe.north = south + 401 * recipe.step;
    recipe.value = [&](int column, int row, int) {
      const double h = whole->heights[static_cast<std::size_t>(1200 - row) * whole->posts.columns + 780 +
                                      static_cast<std::size_t>(column)];
      return std::isnan(h) ? 5000.0 : h;
    };
    const auto baked = test::bakeInto(dir_, test::writeRaster(dir_ / "everest.tif", recipe));
    ASSERT_TRUE(baked) << toString(baked.findings());
    use(baked.value());
  }

 private:
  test::ScratchDir dir_;
};

TEST_F(CullingViews, loseNothingOverEverest) {
  TRIMTAB_NEEDS_SHARED("data/dem-srtm3-everest");
  useShared("dem-srtm3-everest");
  prove(TerrainForm::levels, 25, 11);
  prove(TerrainForm::patches, 25, 12);
}

TEST_F(CullingViews, loseNothingOverTheMountainsOfBigTujunga) {
  TRIMTAB_NEEDS_SHARED("data/dem-30m-bigtujunga");
  useShared("dem-30m-bigtujunga");
  prove(TerrainForm::levels, 25, 21);
  prove(TerrainForm::patches, 25, 22);
}

TEST_F(CullingViews, loseNothingOverTheSample) {
  const test::ScratchDir dir;
  terrain::SampleOptions options;
  options.postM = 90;
  ASSERT_TRUE(terrain::writeSample(dir / "sample.tif", options));
  auto baked = terrain::openOrBake(dir / "sample.tif", dir / "cache", {});
  ASSERT_TRUE(baked) << toString(baked.findings());
  use(baked.value());
  prove(TerrainForm::levels, 25, 31);
  prove(TerrainForm::patches, 25, 32);
}

TEST_F(CullingViews, loseNothingAcrossTheDateLine) {
  TRIMTAB_NEEDS_SHARED("data/dem-srtm3-everest");
  useEverestAt(179.84, 50);
  ASSERT_LT(database->info().northEast.longitude, database->info().southWest.longitude);
  prove(TerrainForm::levels, 25, 41);
  prove(TerrainForm::patches, 25, 42);
}

TEST_F(CullingViews, loseNothingBesideAPole) {
  TRIMTAB_NEEDS_SHARED("data/dem-srtm3-everest");
  useEverestAt(10, 89.6);
  ASSERT_GT(database->info().northEast.latitude, Degrees{89.9});
  prove(TerrainForm::levels, 25, 51);
  prove(TerrainForm::patches, 25, 52);
}

// Without this, the tests above might pass because nothing can go wrong where they look.
TEST_F(CullingViews, showWhatIsCulledWrongly) {
  use(test::syntheticMountains());
  constexpr DepthMapSize kCoarse{12, 9};
  std::vector<View> views;
  for (const auto& r : anyViews(24, 1)) views.push_back(truthOf(r, false));
  for (const OcclusionMethod method : {OcclusionMethod::depth_map, OcclusionMethod::horizon})
    for (const double lowering : {0.0, 1.0}) {
      renderer.plant({.loweringScale = lowering});
      Tally tally;
      for (const View& view : views) compare(view, CullingCase::proposed, method, kCoarse, tally);
      EXPECT_EQ(tally.wrongNodes > 0, lowering < 1);
      EXPECT_GE(tally.wrongPixels, tally.wrongNodes);
    }
  std::size_t found = 0;
  for (const View& view : views) {
    if (view.owners.empty()) continue;
    // The one that shows least.
    const auto least = *std::min_element(view.owners.begin(), view.owners.end(),
                                         [](auto a, auto b) { return a.second < b.second; });
    renderer.plant({.culledNode = least.first});
    Tally tally;
    compare(view, CullingCase::view_frustum, OcclusionMethod::horizon, kCoarse, tally);
    EXPECT_EQ(tally.wrongNodes, 1u);
    EXPECT_EQ(tally.wrongPixels, least.second);
    ++found;
  }
  EXPECT_GT(found, 18u);
}

}  // namespace
}  // namespace trimtab
