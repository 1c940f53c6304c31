#include <cmath>

#include "rasters.h"
#include "tests/core/terrain/elevation/read_elevation.h"

namespace trimtab::terrain {
namespace {

/// Part of one large raster of 100 x 80 posts.
test::RasterRecipe part(int column, int row, int columns, int rows) {
  test::RasterRecipe recipe;
  recipe.columns = columns;
  recipe.rows = rows;
  recipe.west = 10 + column * recipe.step;
  recipe.north = 50 - row * recipe.step;
  recipe.value = [=](int c, int r, int) { return test::roughGround(column + c, row + r); };
  return recipe;
}

class Mosaic : public ::testing::Test {
 protected:
  Result<test::Imported> join(const std::vector<test::RasterRecipe>& recipes) {
    std::vector<std::filesystem::path> files;
    for (const auto& recipe : recipes)
      files.push_back(test::writeRaster(dir_ / (std::to_string(files.size()) + ".tif"), recipe));
    return test::importElevation(files);
  }
  test::ScratchDir dir_;
};

TEST_F(Mosaic, ofPartsIsTheWhole) {
  const auto whole = join({part(0, 0, 100, 80)});
  ASSERT_TRUE(whole);
  const std::vector<std::vector<test::RasterRecipe>> cuts = {
      {part(0, 0, 50, 80), part(50, 0, 50, 80)},  // side by side
      {part(0, 0, 51, 80), part(50, 0, 50, 80)},  // one column shared
      {part(0, 0, 70, 80), part(30, 0, 70, 80)},  // overlapping
      {part(60, 50, 40, 30), part(0, 0, 60, 50), part(60, 0, 40, 50),
       part(0, 50, 60, 30)},  // four, in no order
  };
  for (const auto& parts : cuts) {
    const auto joined = join(parts);
    ASSERT_TRUE(joined) << toString(joined.findings());
    EXPECT_EQ(joined->grid.posts.columns, 100u);
    EXPECT_EQ(joined->grid.posts.rows, 80u);
    EXPECT_EQ(joined->grid.heights, whole->grid.heights);
    EXPECT_EQ(joined->voidsFilled, 0u);
  }
}

TEST_F(Mosaic, fillsAVoidFromAFileThatHasTheGround) {
  auto holed = part(0, 0, 100, 80);
  holed.noData = -5;
  holed.value = [](int c, int r, int) { return c > 40 && c < 60 && r > 20 ? -5 : test::roughGround(c, r); };
  const auto whole = join({part(0, 0, 100, 80)}), joined = join({holed, part(30, 10, 40, 70)});
  ASSERT_TRUE(whole && joined);
  EXPECT_EQ(joined->voidsFilled, 0u);
  EXPECT_EQ(joined->grid.heights, whole->grid.heights);
}

TEST_F(Mosaic, takesTheFinestSpacing) {
  auto coarse = part(0, 0, 50, 40);
  coarse.step = 0.002;
  coarse.value = [](int c, int, int) { return 10.0 * c; };
  auto fine = part(100, 0, 40, 80);
  fine.value = [](int, int, int) { return 7.0; };
  const auto joined = join({coarse, fine});
  ASSERT_TRUE(joined);
  EXPECT_NEAR(joined->grid.posts.stepLongitude, 0.001, 1e-12);
  // The fine file's posts stay what they are; a slope stays one between the coarse posts.
  const PostGrid& posts = joined->grid.posts;
  EXPECT_NEAR(std::remainder(posts.west - 10.1005, 0.001), 0, 1e-9);
  const std::size_t row = std::size_t{40} * posts.columns;
  for (std::uint32_t c = 2; c < 90; ++c)
    ASSERT_NEAR(joined->grid.heights[row + c], (posts.longitude(c) - 10.001) / 0.002 * 10, 1e-3) << c;
}

TEST_F(Mosaic, believesTheFinerOfTwoFiles) {
  auto coarse = part(0, 0, 50, 40);
  coarse.step = 0.002;
  coarse.value = [](int, int, int) { return 10.0; };
  auto fine = part(0, 0, 100, 80);
  for (const bool coarseFirst : {true, false}) {
    const auto joined = coarseFirst ? join({coarse, fine}) : join({fine, coarse});
    ASSERT_TRUE(joined);
    const auto only = join({fine});
    EXPECT_EQ(joined->grid.heights, only->grid.heights);
  }
}

TEST_F(Mosaic, saysWhatEachFileGave) {
  auto under = part(20, 20, 20, 20);
  const auto joined = join({part(0, 0, 75, 80), part(75, 0, 25, 80), under});
  ASSERT_TRUE(joined);
  const std::string notes = toString(joined.findings());
  EXPECT_NE(notes.find("75.0 % of the heights"), std::string::npos) << notes;
  EXPECT_NE(notes.find("25.0 % of the heights"), std::string::npos) << notes;
  EXPECT_NE(notes.find("none: others have the ground there"), std::string::npos) << notes;
}

TEST_F(Mosaic, joinsAcrossTheDateLine) {
  auto west = part(0, 0, 40, 40), east = part(0, 0, 40, 40);
  west.west = 179.96;
  east.west = -180;
  west.value = east.value = [](int, int r, int) { return 3.0 * r; };
  const auto joined = join({west, east});
  ASSERT_TRUE(joined) << toString(joined.findings());
  EXPECT_EQ(joined->grid.posts.columns, 80u);
}

TEST_F(Mosaic, refusesFilesTooFarApart) {
  auto near = part(0, 0, 40, 40), far = part(0, 0, 40, 40);
  far.west = 150;
  near.step = far.step = 0.0001;
  far.north = -30;
  const auto joined = join({near, far});
  ASSERT_FALSE(joined);
  EXPECT_NE(toString(joined.findings()).find("thousand million"), std::string::npos);
}

TEST_F(Mosaic, readsAFolderAndLeavesImagesOut) {
  test::RasterRecipe picture;
  picture.bands = 3;
  picture.type = GDT_Byte;
  test::writeRaster(dir_ / "picture.tif", picture);
  test::writeFile(dir_ / "notes.txt", "not a raster");
  test::writeRaster(dir_ / "a.tif", part(0, 0, 50, 80));
  std::filesystem::create_directory(dir_ / "more");
  test::writeRaster(dir_.path() / "more/b.tif", part(50, 0, 50, 80));
  const std::vector<std::filesystem::path> folder{dir_.path()};
  const auto joined = test::importElevation(folder);
  ASSERT_TRUE(joined) << toString(joined.findings());
  EXPECT_EQ(joined->grid.posts.columns, 100u);
}

}  // namespace
}  // namespace trimtab::terrain
