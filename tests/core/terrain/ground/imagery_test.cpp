#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "tests/core/terrain/elevation/rasters.h"
#include "trimtab/terrain/bake/bake.h"
#include "trimtab/terrain/elevation/source.h"

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

/// Colours of the south-western tile's post (i, j), counted from its corner.
std::array<int, 3> colourAt(const Database& database, int i, int j) {
  TileMesh mesh;
  database.buildTile(0, mesh);
  const std::uint8_t* colour = mesh.vertices[static_cast<std::size_t>(j * TileMesh::kSide + i)].colour;
  return {colour[0], colour[1], colour[2]};
}
void mark(const std::filesystem::path& file, int band, GDALColorInterp as) {
  GDALDataset* data = GDALDataset::FromHandle(GDALOpen(file.c_str(), GA_Update));
  data->GetRasterBand(band)->SetColorInterpretation(as);
  GDALClose(data);
}
void expectSays(const Findings& findings, std::initializer_list<const char*> words) {
  const std::string text = toString(findings);
  for (const char* word : words) EXPECT_NE(text.find(word), std::string::npos) << word << ": " << text;
}

TEST_F(Imagery, isNotHiddenByAnInfraredBandThatIsMarkedAsAlpha) {
  test::RasterRecipe picture;
  picture.bands = 4;
  picture.type = GDT_Byte;
  for (const bool dark : {false, true}) {
    picture.value = [dark](int c, int r, int band) {
      return band == 4 ? (dark ? 20 : 90) + (c * 5 + r * 3) % 100 : colourOf(c, r, band);
    };
    const auto file = test::writeRaster(dir_ / "infrared.tif", picture);
    mark(file, 4, GCI_AlphaBand);
    const auto database = bakeWith(file);
    ASSERT_TRUE(database) << toString(database.findings());
    expectSays(database.findings(), {"infrared.tif", "left out"});
    for (const int i : {0, 7, 30}) {
      const auto colour = colourAt(**database, i, i);
      EXPECT_NEAR(colour[0], 3 * i, 1);
      EXPECT_NEAR(colour[1], 3 * (64 - i), 1);
      EXPECT_NEAR(colour[2], 40, 1);
    }
  }
  // A mask with soft edges stays one.
  picture.value = [](int c, int, int band) { return band == 4 ? std::clamp((30 - c) * 32, 0, 255) : 250; };
  const auto masked = test::writeRaster(dir_ / "masked.tif", picture);
  mark(masked, 4, GCI_AlphaBand);
  const auto database = bakeWith(masked);
  ASSERT_TRUE(database);
  EXPECT_EQ(toString(database.findings()).find("left out"), std::string::npos);
  EXPECT_EQ(colourAt(**database, 5, 5)[0], 250);
  EXPECT_LT(colourAt(**database, 32, 5)[0], 200);
}

TEST_F(Imagery, mayBeAFolderOfTiles) {
  const auto folder = dir_ / "tiles";
  std::filesystem::create_directories(folder / "more");
  test::RasterRecipe tile = test::anyColours(33, 65);
  tile.value = [](int, int, int) { return 200; };
  test::writeRaster(folder / "west.tif", tile);
  tile.west = 10.033;
  tile.value = [](int, int, int) { return 30; };
  test::writeRaster(folder / "more/east.tif", tile);
  tile.west = 20;
  test::writeRaster(folder / "elsewhere.tif", tile);
  test::writeFile(folder / "notes.txt", "no image");
  test::writeFile(folder / "cut.tif", test::readFile(folder / "west.tif").substr(0, 200));
  const auto database = bakeWith(folder);
  ASSERT_TRUE(database) << toString(database.findings());
  expectSays(database.findings(), {"cut.tif", "left out", "1 of 4 lie elsewhere"});
  EXPECT_FALSE(hasError(database.findings()));
  EXPECT_EQ(colourAt(**database, 3, 9)[0], 200);
  TileMesh mesh;
  (*database)->buildTile(1, mesh);
  EXPECT_EQ(mesh.vertices[20].colour[0], 30);
}

TEST_F(Imagery, tellsNothingAFolderWithoutImagesAndAnEmptyFileApart) {
  std::filesystem::create_directory(dir_ / "none");
  test::writeFile(dir_ / "none/notes.txt", "no image");
  test::writeFile(dir_ / "empty.tif", "");
  for (const auto& [name, said] : {std::pair{"absent.tif", "nothing there"},
                                   {"none", "no raster among 1 files"},
                                   {"empty.tif", "empty"}}) {
    const auto refused = bakeWith(dir_ / name);
    ASSERT_FALSE(refused) << name;
    expectSays(refused.findings(), {name, said});
  }
  const auto folder = openElevation(std::vector<std::filesystem::path>{dir_ / "empty.tif"});
  ASSERT_FALSE(folder);
  expectSays(folder.findings(), {"an empty file"});
}

/// Ground control points of an image of 65 x 65 pixels over the ground of these tests, moved by a bend.
std::filesystem::path withPoints(const std::filesystem::path& file, double bend) {
  test::RasterRecipe picture = test::anyColours(65, 65);
  picture.placed = false, picture.crs = "";
  picture.value = colourOf;
  test::writeRaster(file, picture);
  GDALDataset* data = GDALDataset::FromHandle(GDALOpen(file.c_str(), GA_Update));
  std::vector<GDAL_GCP> points;
  for (const double x : {0.0, 32.5, 65.0})
    for (const double y : {0.0, 32.5, 65.0}) {
      points.emplace_back();
      GDALInitGCPs(1, &points.back());
      points.back().dfGCPPixel = x, points.back().dfGCPLine = y;
      points.back().dfGCPX = 10 + 0.001 * x + (x == 32.5 ? bend : 0);
      points.back().dfGCPY = 50 - 0.001 * y;
    }
  OGRSpatialReference crs;
  crs.SetFromUserInput("EPSG:4326");
  crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  data->SetGCPs(static_cast<int>(points.size()), points.data(), &crs);
  GDALClose(data);
  GDALDeinitGCPs(static_cast<int>(points.size()), points.data());
  return file;
}

TEST_F(Imagery, isPlacedByControlPointsOnAPlaneMapAndRefusedWithOthers) {
  const auto placed = bakeWith(withPoints(dir_ / "plane.tif", 0));
  ASSERT_TRUE(placed) << toString(placed.findings());
  expectSays(placed.findings(), {"9 ground control points"});
  for (const int i : {1, 12, 31}) {
    EXPECT_NEAR(colourAt(**placed, i, i)[0], 3 * i, 2);
    EXPECT_NEAR(colourAt(**placed, i, i)[1], 3 * (64 - i), 2);
  }
  const auto refused = bakeWith(withPoints(dir_ / "bent.tif", 0.004));
  ASSERT_FALSE(refused);
  expectSays(refused.findings(), {"bent.tif", "9 ground control points", "gdalwarp"});
}

TEST_F(Imagery, thatIsCutIsAFindingWithGdalsReasonAndNothingElseIsPrinted) {
  test::RasterRecipe picture = test::anyColours(65, 65);
  const auto whole = test::writeRaster(dir_ / "whole.tif", picture);
  GDALDataset* from = GDALDataset::Open(whole.c_str());
  const char* const options[] = {"COMPRESS=JPEG", "BLOCKYSIZE=8", nullptr};
  GDALClose(GetGDALDriverManager()->GetDriverByName("GTiff")->CreateCopy(
      (dir_ / "jpeg.tif").c_str(), from, FALSE, const_cast<char**>(options), nullptr, nullptr));
  GDALClose(from);
  const std::string bytes = test::readFile(dir_ / "jpeg.tif");
  test::writeFile(dir_ / "cut.tif", bytes.substr(0, bytes.size() * 7 / 10));
  ::testing::internal::CaptureStderr();
  const auto cut = bakeWith(dir_ / "cut.tif");
  const std::string printed = ::testing::internal::GetCapturedStderr();
  EXPECT_EQ(printed, "");
  ASSERT_FALSE(cut);
  expectSays(cut.findings(), {"cut.tif"});
  const std::string text = toString(cut.findings());
  EXPECT_EQ(text.find("gives no reason"), std::string::npos) << text;
  EXPECT_EQ(text.find("georeference"), std::string::npos) << text;
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
