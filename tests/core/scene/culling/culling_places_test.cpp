#include <cmath>

#include "culling_truth.h"
#include "tests/core/terrain/elevation/rasters.h"
#include "tests/core/terrain/elevation/read_elevation.h"

/// As culling_views_test.cpp, with the heights around Everest where the earth's coordinates are odd.
namespace trimtab {
namespace {

class CullingPlaces : public test::CullingTruth {
 protected:
  /// 401 x 401 posts around Everest, elsewhere on the earth, as wide there as they are here.
  void useEverestAt(double west, double south) {
    const auto file = test::sharedDir() / "data/dem-srtm3-everest/N27E086.hgt";
    const auto whole = test::readElevation(file);
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

TEST_F(CullingPlaces, loseNothingAcrossTheDateLine) {
  TRIMTAB_NEEDS_SHARED("data/dem-srtm3-everest");
  useEverestAt(179.84, 50);
  ASSERT_LT(database->info().northEast.longitude, database->info().southWest.longitude);
  prove({{TerrainForm::tiles, 13}, {TerrainForm::patches, 12}}, 41);
}

TEST_F(CullingPlaces, loseNothingBesideAPole) {
  TRIMTAB_NEEDS_SHARED("data/dem-srtm3-everest");
  useEverestAt(10, 89.6);
  ASSERT_GT(database->info().northEast.latitude, Degrees{89.9});
  prove({{TerrainForm::tiles, 13}, {TerrainForm::patches, 12}}, 51);
}

}  // namespace
}  // namespace trimtab
