#include <algorithm>
#include <cmath>

#include "tests/core/terrain/elevation/rasters.h"
#include "trimtab/terrain/bake/bake.h"

namespace trimtab::terrain {
namespace {

class Imagery : public ::testing::Test {
 protected:
  Result<std::shared_ptr<const Database>> bakeWith(const std::filesystem::path& image) {
    BakeOptions options;
    options.sources = {test::writeRaster(dir_ / "ground.tif", {})};
    options.imagery = image;
    options.output = dir_ / "db";
    return bake(options);
  }
  test::ScratchDir dir_;
};

double colourOf(int c, int r, int band) {
  return band == 1 ? 3 * c : band == 2 ? 3 * r : 40;
}

TEST_F(Imagery, liesOnThePostsItBelongsTo) {
  test::RasterRecipe picture;
  picture.bands = 3;
  picture.type = GDT_Byte;
  picture.value = colourOf;
  const auto database = bakeWith(test::writeRaster(dir_ / "rgb.tif", picture));
  ASSERT_TRUE(database) << toString(database.findings());
  EXPECT_TRUE((*database)->info().hasImage);
  const auto again = Database::open(dir_ / "db");
  ASSERT_TRUE(again);
  TileMesh mesh;
  (*again)->buildTile(0, mesh);  // south-west
  for (int j = 0; j < TileMesh::kSide; ++j)
    for (int i = 0; i < TileMesh::kSide; ++i) {
      const std::uint8_t* colour = mesh.vertices[static_cast<std::size_t>(j * TileMesh::kSide + i)].colour;
      ASSERT_NEAR(colour[0], 3 * i, 1);
      ASSERT_NEAR(colour[1], 3 * (64 - j), 1);
      ASSERT_NEAR(colour[2], 40, 1);
    }
}

TEST_F(Imagery, isWarpedFromItsOwnProjection) {
  test::RasterRecipe picture;
  picture.bands = 3;
  picture.type = GDT_Byte;
  picture.crs = "EPSG:32632";  // 10 E 50 N is at 571,667 m east, 5,539,109 m north
  picture.west = 570000, picture.north = 5541000, picture.step = 50;
  picture.columns = picture.rows = 220;
  picture.value = [](int c, int, int) { return c < 150 ? 200 : 20; };  // changes at 577,500 m east
  const auto database = bakeWith(test::writeRaster(dir_ / "utm.tif", picture));
  ASSERT_TRUE(database) << toString(database.findings());
  TileMesh mesh;
  (*database)->buildTile((*database)->index().size() > 4 ? 4 : 0, mesh);
  EXPECT_NEAR(mesh.vertices[0].colour[0], 200, 2);
}

TEST_F(Imagery, leavesGroundWithoutItToTheLand) {
  test::RasterRecipe picture;
  picture.bands = 4;
  picture.type = GDT_Byte;
  picture.value = [](int c, int, int band) { return band == 4 ? (c < 20 ? 255 : 0) : 250; };
  const auto database = bakeWith(test::writeRaster(dir_ / "rgba.tif", picture));
  ASSERT_TRUE(database);
  TileMesh mesh;
  (*database)->buildTile(0, mesh);
  EXPECT_EQ(mesh.vertices[5].colour[0], 250);
  EXPECT_LT(mesh.vertices[28].colour[0], 200);
}

/// Once, however the database comes about.
TEST_F(Imagery, tellsHowMuchOfTheGroundIsWithoutIt) {
  test::RasterRecipe picture;
  picture.bands = 4;
  picture.type = GDT_Byte;
  picture.value = [](int c, int, int band) { return band == 4 ? (c < 20 ? 255 : 0) : 250; };
  BakeOptions options;
  options.sources = {test::writeRaster(dir_ / "ground.tif", {})};
  options.imagery = test::writeRaster(dir_ / "rgba.tif", picture);
  const auto expectToldOnce = [](const Findings& findings) {
    EXPECT_EQ(std::count_if(findings.begin(), findings.end(),
                            [](const Finding& f) {
                              return f.severity == Severity::note &&
                                     f.where.find("rgba.tif") != std::string::npos &&
                                     f.found == "69 % of it without";
                            }),
              1)
        << toString(findings);
  };

  options.output = dir_ / "whole";
  const auto whole = bake(options);
  ASSERT_TRUE(whole);
  expectToldOnce(whole.findings());

  options.output = dir_ / "resumed";
  options.progress = [](double fraction, const std::string&) { return fraction < 0.97; };
  ASSERT_FALSE(bake(options));
  options.progress = {};
  const auto resumed = bake(options);
  ASSERT_TRUE(resumed);
  expectToldOnce(resumed.findings());

  options.output = dir_ / "parts";
  for (const std::uint32_t part : {1u, 2u, 3u}) ASSERT_TRUE(bakePart(options, part, 3));
  const auto joined = bakeJoin(options);
  ASSERT_TRUE(joined);
  expectToldOnce(joined.findings());
}

TEST_F(Imagery, tellsSoWhereThereIsNoMemoryForTiles) {
  test::RasterRecipe ground, picture;
  ground.columns = ground.rows = 3500;
  ground.step = 0.0001;
  picture.bands = 3;
  picture.type = GDT_Byte;
  picture.step = 0.0035;
  BakeOptions options;
  options.sources = {test::writeRaster(dir_ / "ground.tif", ground)};
  options.imagery = test::writeRaster(dir_ / "rgb.tif", picture);
  options.memory = Megabytes{64};
  options.output = dir_ / "db";
  const auto database = bake(options);
  ASSERT_TRUE(database) << toString(database.findings());
  EXPECT_EQ((*database)->index().size(), 0u);
  EXPECT_NE(toString(database.findings()).find("% of it without"), std::string::npos)
      << toString(database.findings());
}

TEST_F(Imagery, meetsATerrainAcrossTheDateLine) {
  test::RasterRecipe ground, picture;
  ground.west = 179.97;
  picture.west = -180, picture.bands = 3, picture.type = GDT_Byte;
  picture.value = [](int, int, int band) { return band == 1 ? 250.0 : 0.0; };
  BakeOptions options;
  options.sources = {test::writeRaster(dir_ / "ground.tif", ground)};
  options.imagery = test::writeRaster(dir_ / "rgb.tif", picture);
  options.output = dir_ / "db";
  const auto database = bake(options);
  ASSERT_TRUE(database) << toString(database.findings());
  TileMesh mesh;
  (*database)->buildTile(0, mesh);
  EXPECT_LT(mesh.vertices[28].colour[0], 200) << "west of the line";
  EXPECT_EQ(mesh.vertices[31].colour[0], 250);
}

TEST_F(Imagery, fromElsewhereOrNoImageIsRefused) {
  test::RasterRecipe picture;
  picture.bands = 3;
  picture.type = GDT_Byte;
  picture.west = 60;
  const auto elsewhere = bakeWith(test::writeRaster(dir_ / "far.tif", picture));
  ASSERT_FALSE(elsewhere);
  EXPECT_NE(toString(elsewhere.findings()).find("far.tif"), std::string::npos);
  const auto heights = bakeWith(test::writeRaster(dir_ / "heights.tif", {}));
  ASSERT_FALSE(heights);
  EXPECT_NE(toString(heights.findings()).find("Float32"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(dir_ / "db"));
}

TEST_F(Imagery, ofCraterLakeCoversItsTerrain) {
  TRIMTAB_NEEDS_SHARED("data/dem-image-craterlake");
  BakeOptions options;
  options.sources = {test::sharedDir() / "data/dem-image-craterlake/craterlake-elev-16bit-30m.tif"};
  options.imagery = test::sharedDir() / "data/dem-image-craterlake/craterlake-imagery-30m.tif";
  options.output = dir_ / "db";
  const auto database = bake(options);
  ASSERT_TRUE(database) << toString(database.findings());
  EXPECT_EQ((*database)->info().voidsFilled, 39489u);
}

}  // namespace
}  // namespace trimtab::terrain
