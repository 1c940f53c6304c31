#include <algorithm>
#include <cmath>

#include "elevation_fixture.h"

/// Posts at another distance than the files': means where files are finer.
namespace trimtab::terrain {
namespace {

TEST_F(Elevation, hasNoVoidsWhereFilesAreFinerOnOneAxisAlone) {
  // 10 m x 40 m, and on its side.
  auto upright = inUtm(32, 47.59, 11.9, 40, 800, 200), lying = inUtm(32, 47.59, 11.9, 10, 200, 800);
  upright.stepEast = 10, lying.stepEast = 40;
  // As tiles are at high latitudes: of half the posts across from one parallel on.
  auto wide = degrees(20, 70, 1 / 3600.0, 200, 300),
       narrow = degrees(20, 70 + 300 / 3600.0, 1 / 3600.0, 100, 300);
  wide.stepEast = 1.5 / 3600, narrow.stepEast = 3 / 3600.0;
  struct Case {
    const char* name;
    std::vector<TrueRaster> rasters;
    double postM, finestM, coarsestM;
  };
  for (const Case& c :
       {Case{"upright", {upright}, 20, 10, 40}, Case{"lying", {lying}, 20, 10, 40},
        Case{"tiles", {wide, narrow}, 50, 16, 50}, Case{"tiles, closer", {wide, narrow}, 31, 16, 32}}) {
    ElevationOptions options;
    options.stepLatitude = c.postM / 111320;
    const auto source = open(c.rasters, options);
    ASSERT_TRUE(source) << c.name;
    std::vector<std::uint8_t> beyond;
    const auto heights = test::readBands(*source, 32, &beyond);
    std::size_t voids = 0;
    for (std::size_t i = 0; i < heights.size(); ++i)
      if (std::isnan(heights[i]) && beyond[i] == 0) ++voids;
    EXPECT_EQ(voids, 0u) << c.name;
    const auto [worst, count] = error(source->posts(), heights);
    // The middle of the posts that are averaged is up to half a post off.
    EXPECT_LT(worst, test::bilinearLimit(c.coarsestM) + test::kSlope * c.finestM / 2) << c.name;
    EXPECT_GT(count, heights.size() * 9 / 10) << c.name;
    std::printf("%-14s %zu posts, worst %.3f m\n", c.name, count, worst);
  }
}

TEST_F(Elevation, isAveragedToACoarserSpacingWhenAskedFor) {
  ElevationOptions options;
  options.stepLatitude = 0.002;
  const auto source =
      open({degrees(11.9, 47.6, 0.0005, 400, 400), inUtm(33, 47.59, 12.02, 40, 200, 400)}, options);
  ASSERT_TRUE(source);
  EXPECT_EQ(source->posts().stepLatitude, 0.002);
  EXPECT_NEAR(source->posts().columns * source->posts().stepLongitude, 0.22, 0.03);
  const auto [worst, count] = error(source->posts(), test::readBands(*source, 32));
  EXPECT_LT(worst, 3 * test::bilinearLimit(220));
  EXPECT_GT(count, 6000u);
}

TEST_F(Elevation, isTheMeanOfMorePostsThanAreReadAtATime) {
  test::RasterRecipe recipe;
  recipe.columns = recipe.rows = 3001, recipe.step = 0.0002;
  recipe.value = [](int c, int r, int) { return 0.1 * c + 0.25 * r; };
  const fs::path file = test::writeRaster(dir_ / "plane.tif", recipe);
  ElevationOptions options;
  options.stepLatitude = 1500 * recipe.step;
  const auto source = openElevation(std::span(&file, 1), options);
  ASSERT_TRUE(source);
  ASSERT_EQ(source.value()->posts().size(), 9u);
  // Half of the box, where it ends with the raster. A post at its edge is within or is not.
  const auto heights = test::readBands(*source.value(), 3);
  for (const std::size_t row : {0u, 1u, 2u})
    for (const std::size_t column : {0u, 1u, 2u}) {
      const std::array<double, 3> middle{375, 1500, 2625};
      EXPECT_NEAR(heights[row * 3 + column], 0.1 * middle[column] + 0.25 * middle[2 - row], 0.2);
    }
}

}  // namespace
}  // namespace trimtab::terrain
