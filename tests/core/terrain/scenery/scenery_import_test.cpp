#include <cmath>
#include <random>
#include <regex>

#include "scenery_grid.h"
#include "scenery_tiles.h"
#include "tests/core/terrain/elevation/rasters.h"
#include "trimtab/terrain/bake/bake.h"
#include "trimtab/terrain/bake/cache.h"
#include "trimtab/terrain/format/database.h"
#include "trimtab/terrain/format/store.h"
#include "trimtab/terrain/scenery/import.h"
#include "trimtab/terrain/static_lod/static_lod.h"

namespace trimtab {
namespace {

using terrain::SceneryMesh;

double hills(double longitude, double latitude) {
  return 400 + 150 * std::sin(longitude * 90) * std::cos(latitude * 110);
}

SceneryMesh meshOf(const test::TileRecipe& recipe) {
  auto mesh = terrain::parseBtg(test::gridTile(recipe), "3072816.btg");
  return std::move(mesh).value();
}

/// Height of the highest triangle over a place, by trying all of them in degrees.
std::optional<double> bruteHeight(std::span<const SceneryMesh> meshes, double longitude, double latitude) {
  std::optional<double> highest;
  for (const SceneryMesh& mesh : meshes) {
    std::vector<std::array<double, 3>> places;
    for (const Vec3& v : mesh.vertices) {
      const GeodeticPosition p = toGeodetic(v);
      places.push_back({p.longitude.value(), p.latitude.value(), p.height.value()});
    }
    for (const auto& t : mesh.triangles) {
      const auto &a = places[t.vertex[0]], &b = places[t.vertex[1]], &c = places[t.vertex[2]];
      const double det = (b[1] - c[1]) * (a[0] - c[0]) + (c[0] - b[0]) * (a[1] - c[1]);
      if (det == 0) continue;
      const double u = ((b[1] - c[1]) * (longitude - c[0]) + (c[0] - b[0]) * (latitude - c[1])) / det;
      const double v = ((c[1] - a[1]) * (longitude - c[0]) + (a[0] - c[0]) * (latitude - c[1])) / det;
      const double w = 1 - u - v;
      if (std::min({u, v, w}) < -1e-6) continue;
      const double height = u * a[2] + v * b[2] + w * c[2];
      if (!highest || height > *highest) highest = height;
    }
  }
  return highest;
}

TEST(SceneryPosts, reachFromBorderToBorderAndKeepTheDistance) {
  const std::vector<SceneryMesh> meshes{meshOf({})};
  const auto posts = terrain::sceneryPosts(meshes, Metres{100});
  ASSERT_TRUE(posts);
  EXPECT_EQ(posts->west, 7);
  EXPECT_EQ(posts->south, 50.5);
  EXPECT_NEAR(posts->longitude(posts->columns - 1), 7.25, 1e-12);
  EXPECT_NEAR(posts->latitude(posts->rows - 1), 50.625, 1e-12);
  EXPECT_LE(posts->stepLatitude * 111320, 100);
  EXPECT_GE(posts->stepLatitude * 111320, 98);
  const auto fine = terrain::sceneryPosts(meshes, {});
  EXPECT_NEAR(fine->stepLatitude * 111320, 30, 1);
  for (const double bad : {1e-3, 0.0, -5.0, std::nan("")})
    EXPECT_FALSE(terrain::sceneryPosts(meshes, Metres{bad})) << bad;
  EXPECT_FALSE(terrain::sceneryPosts({}, {}));
  // A tile of some 18 x 14 km.
  const auto fineBeyond = terrain::sceneryPosts(meshes, Metres{0.1});
  ASSERT_FALSE(fineBeyond);
  EXPECT_TRUE(std::regex_match(fineBeyond.findings()[0].found, std::regex("[0-9]{11} posts, 0.1 m apart")))
      << toString(fineBeyond.findings());
}

TEST(Rasterised, isTheHighestSurfaceAtEachPost) {
  test::TileRecipe low, high;
  low.heightM = hills;
  high.heightM = [](double, double) { return 450.0; };
  high.west = 7.0625;
  high.width = 0.125;
  const std::vector<SceneryMesh> meshes{meshOf(high), meshOf(low)};
  const auto posts = terrain::sceneryPosts(meshes, Metres{200});
  const auto grid = test::rasterised(meshes, *posts);
  ASSERT_TRUE(posts && grid);
  std::size_t ofHigh = 0;
  for (std::uint32_t r = 0; r < posts->rows; ++r)
    for (std::uint32_t c = 0; c < posts->columns; ++c) {
      const auto expected = bruteHeight(meshes, posts->longitude(c), posts->latitude(r));
      const float found = grid->heights[std::size_t{r} * posts->columns + c];
      ASSERT_FALSE(std::isnan(found)) << r << ' ' << c;
      ASSERT_TRUE(expected);
      EXPECT_NEAR(found, *expected, 0.02) << r << ' ' << c;
      if (std::abs(found - 450) < 0.02) ++ofHigh;
    }
  EXPECT_GT(ofHigh, posts->size() / 4);
  EXPECT_EQ(grid->outside, 0U);
}

TEST(Rasterised, hasTheMaterialsColourAtEachPost) {
  const std::vector<SceneryMesh> meshes{meshOf({})};
  const auto posts = terrain::sceneryPosts(meshes, Metres{500});
  const auto grid = test::rasterised(meshes, *posts);
  ASSERT_TRUE(grid);
  const auto lake = terrain::materialColour("Lake"), forest = terrain::materialColour("EvergreenForest");
  for (std::uint32_t r = 0; r < posts->rows; ++r)
    for (std::uint32_t c = 0; c < posts->columns; ++c) {
      const std::uint8_t* pixel = &grid->image[(std::size_t{r} * posts->columns + c) * 4];
      const double longitude = posts->longitude(c);
      if (std::abs(longitude - 7.125) < 1e-4) continue;
      const auto& expected = longitude < 7.125 ? lake : forest;
      EXPECT_TRUE(std::equal(expected.begin(), expected.end(), pixel)) << r << ' ' << c;
      EXPECT_EQ(pixel[3], 255);
    }
}

TEST(Rasterised, leavesHolesVoidAndCountsWhatNoTileReaches) {
  test::TileRecipe holed, far;
  holed.hole = true;
  far.west = 7.5;
  far.south = 50.625;
  const std::vector<SceneryMesh> meshes{meshOf(holed), meshOf(far)};
  const auto posts = terrain::sceneryPosts(meshes, Metres{300});
  const auto grid = test::rasterised(meshes, *posts);
  ASSERT_TRUE(grid);
  std::uint64_t outside = 0;
  for (std::uint32_t r = 0; r < posts->rows; ++r)
    for (std::uint32_t c = 0; c < posts->columns; ++c) {
      const double x = posts->longitude(c), y = posts->latitude(r);
      const auto within = [](double v, double low, double high) { return v > low - 1e-9 && v < high + 1e-9; };
      const bool inFirst = within(x, 7, 7.25) && within(y, 50.5, 50.625);
      const bool inSecond = within(x, 7.5, 7.75) && within(y, 50.625, 50.75);
      if (!inFirst && !inSecond) ++outside;
      const bool inHole = x > 7.0626 && x < 7.1249 && y > 50.5313 && y < 50.5624;
      if (!inHole) continue;
      EXPECT_TRUE(std::isnan(grid->heights[std::size_t{r} * posts->columns + c])) << x << ' ' << y;
    }
  EXPECT_EQ(grid->outside, outside);
}

/// The tile of a list that is not there: sea beside tiles at sea level, a void beside hills.
TEST(Rasterised, takesForSeaWhatTilesAtSeaLevelSurround) {
  for (const double level : {0.0, 100.0}) {
    test::TileRecipe first, second;
    first.heightM = second.heightM = [&](double longitude, double) {
      return longitude > 7.2 && longitude < 7.5 ? level : 60.0;
    };
    second.west = 7.5;
    second.south = 50.625;
    second.heightM = [&](double, double) { return level; };
    const std::vector<SceneryMesh> meshes{meshOf(first), meshOf(second)};
    const auto posts = terrain::sceneryPosts(meshes, Metres{300});
    const auto grid = test::rasterised(meshes, *posts);
    ASSERT_TRUE(grid);
    // South of the second tile: it touches the end of the first, at the level, and the second.
    const auto column = static_cast<std::size_t>((7.6 - posts->west) / posts->stepLongitude);
    const auto row = static_cast<std::size_t>((50.55 - posts->south) / posts->stepLatitude);
    const std::size_t post = row * posts->columns + column;
    EXPECT_EQ(level == 0, grid->heights[post] == 0);
    EXPECT_EQ(level == 0, grid->image[post * 4 + 3] == 255);
    EXPECT_EQ(grid.findings().size(), level == 0 ? 1U : 0U);
    EXPECT_EQ(level > 0, grid->outside > posts->size() / 4);
  }
}

TEST(Rasterised, isNoSeaForALittleWaterAtItsEdge) {
  test::TileRecipe first, second;
  first.cells = second.cells = 8;
  first.heightM = [](double longitude, double) { return longitude > 7.2 ? 0.0 : 60.0; };
  second.west = 7.5;
  second.south = 50.625;
  const std::vector<SceneryMesh> meshes{meshOf(first), meshOf(second)};
  const auto posts = terrain::sceneryPosts(meshes, Metres{300});
  const auto grid = test::rasterised(meshes, *posts);
  ASSERT_TRUE(grid);
  EXPECT_GT(grid->outside, posts->size() / 2);
  EXPECT_TRUE(grid.findings().empty());
}

TEST(Rasterised, crossesTheDateLine) {
  test::TileRecipe west, east;
  west.west = 179.75;
  east.west = -180;
  west.south = east.south = 52;
  const std::vector<SceneryMesh> meshes{meshOf(west), meshOf(east)};
  const auto posts = terrain::sceneryPosts(meshes, Metres{500});
  ASSERT_TRUE(posts);
  EXPECT_NEAR(posts->stepLongitude * (posts->columns - 1), 0.5, 1e-9);
  const auto grid = test::rasterised(meshes, *posts);
  for (const float height : grid->heights) EXPECT_NEAR(height, 100, 0.02);
}

class SceneryBake : public ::testing::Test {
 protected:
  SceneryBake() {
    std::filesystem::create_directory(dir_ / "scenery");
    test::TileRecipe recipe;
    recipe.heightM = hills;
    recipe.cells = 8;
    test::writeFile(dir_ / "scenery/3072816.btg.gz", test::gzipped(test::gridTile(recipe)));
    test::writeFile(dir_ / "scenery/3072816.stg", "OBJECT_BASE 3072816.btg\nOBJECT EDNY.btg\n");
  }
  terrain::BakeOptions options() const {
    terrain::BakeOptions all;
    all.sources = {dir_ / "scenery"};
    all.output = dir_ / "db";
    all.post = Metres{150};
    return all;
  }
  test::ScratchDir dir_;
};

TEST_F(SceneryBake, keepsHeightsColoursAndCounts) {
  ASSERT_TRUE(terrain::bake(options()));
  const auto database = terrain::Database::open(dir_ / "db");
  ASSERT_TRUE(database) << toString(database.findings());
  const terrain::TerrainInfo& info = (*database)->info();
  ASSERT_TRUE(info.scenery);
  EXPECT_EQ(info.scenery->tiles, 1U);
  EXPECT_EQ(info.scenery->airports, 0U);
  EXPECT_EQ(info.scenery->trianglesInFile, 128U);
  EXPECT_EQ(info.scenery->triangles, 128U);
  EXPECT_EQ(info.scenery->missing, std::vector<std::string>{"EDNY.btg"});
  EXPECT_TRUE(info.hasImage);
  EXPECT_EQ(info.voidsFilled, 0U);
  EXPECT_EQ(info.name, "scenery");
  const auto mesh = terrain::readBtg(dir_ / "scenery/3072816.btg.gz");
  std::vector<SceneryMesh> meshes{*mesh};
  std::mt19937 random(5);
  std::uniform_real_distribution<double> part(0.01, 0.99);
  for (int i = 0; i < 200; ++i) {
    const double longitude = 7 + 0.25 * part(random), latitude = 50.5 + 0.125 * part(random);
    const auto height = (*database)->heightAt(Degrees{latitude}, Degrees{longitude});
    ASSERT_TRUE(height);
    // Posts 150 m apart, slopes to some 20 %: between posts a crease may be missed by a few metres.
    EXPECT_NEAR(height->value(), *bruteHeight(meshes, longitude, latitude), 8)
        << longitude << ' ' << latitude;
  }
}

TEST_F(SceneryBake, servesTheTreesItWrote) {
  auto fine = options();
  fine.trianglesPerNode = 40;
  const auto baked = terrain::bake(fine);
  ASSERT_TRUE(baked) << toString(baked.findings());
  const auto database = terrain::Database::open(dir_ / "db");
  ASSERT_TRUE(database) << toString(database.findings());
  for (const auto& trees : {(*baked)->staticLod(), (*database)->staticLod()}) {
    ASSERT_TRUE(trees);
    EXPECT_EQ(trees->trianglesPerNode, 40U);
    EXPECT_EQ(trees->counts.sourceTriangles, 128U);
    EXPECT_GE(trees->counts.levels, 3U);
    EXPECT_EQ(trees->index.frame.origin(), (*database)->index().frame.origin());
  }
  EXPECT_EQ((*baked)->info().bytes, (*database)->info().bytes);
}

TEST_F(SceneryBake, leavesABrokenTileOutAndSaysSo) {
  test::writeFile(dir_ / "scenery/3072817.btg.gz", "\x1f\x8b broken");
  for (const auto& entry : std::filesystem::directory_iterator(dir_ / "scenery"))
    if (entry.path().extension() == ".stg") std::filesystem::remove(entry.path());
  const auto baked = terrain::bake(options());
  ASSERT_TRUE(baked) << toString(baked.findings());
  const std::string text = toString(baked.findings());
  EXPECT_NE(text.find("3072817"), std::string::npos) << text;
  EXPECT_NE(text.find("left out"), std::string::npos) << text;
  EXPECT_FALSE(hasError(baked.findings()));
}

TEST_F(SceneryBake, isRefusedIfNoTileCanBeRead) {
  for (const auto& entry : std::filesystem::directory_iterator(dir_ / "scenery"))
    std::filesystem::remove(entry.path());
  for (const char* name : {"scenery/3072816.btg.gz", "scenery/3072817.btg.gz"})
    test::writeFile(dir_ / name, "\x1f\x8b broken");
  const auto baked = terrain::bake(options());
  ASSERT_FALSE(baked);
  EXPECT_TRUE(hasError(baked.findings()));
  EXPECT_NE(toString(baked.findings()).find("3072817"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(dir_ / "db"));
}

TEST_F(SceneryBake, isRefusedWithoutItsTreesOrWithOthers) {
  auto other = options();
  ASSERT_TRUE(terrain::bake(other));
  other.output = dir_ / "other";
  other.trianglesPerNode = 50;
  ASSERT_TRUE(terrain::bake(other));
  const auto trees = dir_ / "db" / terrain::kStaticLodName;
  std::filesystem::copy_file(dir_ / "other" / terrain::kStaticLodName, trees,
                             std::filesystem::copy_options::overwrite_existing);
  const auto foreign = terrain::Database::open(dir_ / "db");
  ASSERT_FALSE(foreign);
  EXPECT_EQ(foreign.findings()[0].key, "triangles per node");
  std::filesystem::remove(trees);
  EXPECT_FALSE(terrain::Database::open(dir_ / "db"));
}

TEST_F(SceneryBake, isTheSameInLittleMemoryButForItsTrees) {
  terrain::BakeOptions all = options();
  const auto whole = terrain::bake(all);
  ASSERT_TRUE(whole);
  EXPECT_TRUE((*whole)->staticLod());
  // No room for trees. Tiles are read again whenever they are needed.
  all.memory = Megabytes{64};
  all.output = dir_ / "little";
  const auto little = terrain::bake(all);
  ASSERT_TRUE(little) << toString(little.findings());
  EXPECT_NE(toString(little.findings()).find("trees"), std::string::npos);
  EXPECT_FALSE((*little)->staticLod());
  EXPECT_TRUE(terrain::Database::open(dir_ / "little"));
  for (const char* name : {terrain::kHeightsName, terrain::kPatchesName, terrain::kGroundName,
                           terrain::kImageName, terrain::kNodesName})
    EXPECT_TRUE(test::readFile(dir_ / "db" / name) == test::readFile(dir_ / "little" / name)) << name;
}

TEST_F(SceneryBake, besideElevationIsTheSameInLittleMemoryButForItsTrees) {
  terrain::BakeOptions all = options();
  test::RasterRecipe around;
  around.columns = 500, around.rows = 300;
  around.west = 6.8, around.north = 50.8;
  all.sources.push_back(test::writeRaster(dir_ / "around.tif", around));
  const auto whole = terrain::bake(all);
  ASSERT_TRUE(whole) << toString(whole.findings());
  all.output = dir_ / "little";
  all.memory = Megabytes{1};
  const auto little = terrain::bake(all);
  ASSERT_TRUE(little) << toString(little.findings());
  EXPECT_TRUE((*whole)->staticLod());
  EXPECT_FALSE((*little)->staticLod());
  EXPECT_NE(toString(little.findings()).find("left out"), std::string::npos);
  for (const char* name : {terrain::kHeightsName, terrain::kPatchesName, terrain::kGroundName})
    EXPECT_TRUE(test::readFile(dir_ / "db" / name) == test::readFile(dir_ / "little" / name)) << name;
}

TEST_F(SceneryBake, takesElevationBesideScenery) {
  auto both = options();
  const auto alone = terrain::bake(both);
  ASSERT_TRUE(alone) << toString(alone.findings());
  both.output = dir_ / "both";
  test::RasterRecipe around;
  around.columns = 500, around.rows = 300;
  around.west = 6.8, around.north = 50.8;
  both.sources.push_back(test::writeRaster(dir_ / "around.tif", around));
  const auto done = terrain::bake(both);
  ASSERT_TRUE(done) << toString(done.findings());
  EXPECT_GT((*done)->info().columns, (*alone)->info().columns);
  EXPECT_EQ((*done)->info().scenery->tiles, (*alone)->info().scenery->tiles);
  ASSERT_TRUE((*done)->staticLod());
  EXPECT_GT((*done)->staticLod()->tiles.size(), (*alone)->staticLod()->tiles.size() + 4);
  EXPECT_NEAR((*done)->heightAt(Degrees{50.78}, Degrees{6.85})->value(), 100, 0.01);
  EXPECT_TRUE(terrain::Database::open(dir_ / "both"));
  // What cannot be read is named, beside scenery too.
  both.output = dir_ / "bad";
  both.sources.back() = dir_ / "n50.hgt";
  test::writeFile(dir_ / "n50.hgt", "heights");
  const auto bad = terrain::bake(both);
  ASSERT_FALSE(bad);
  EXPECT_NE(bad.findings()[0].where.find("n50.hgt"), std::string::npos);
}

TEST_F(SceneryBake, leavesNothingBehindWhenCancelledAtAnyStep) {
  for (int steps = 0;; ++steps) {
    auto some = options();
    int told = 0;
    some.progress = [&](double, const std::string&) { return told++ < steps; };
    if (terrain::bake(some)) break;
    EXPECT_FALSE(std::filesystem::exists(dir_ / "db"));
    ASSERT_LT(steps, 1000);
  }
  std::size_t entries = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(dir_.path())) ++entries;
  EXPECT_EQ(entries, 2U);
}

TEST_F(SceneryBake, isFoundInTheCacheByFilesAndTriangles) {
  const auto cache = dir_ / "cache";
  const auto baked = [&](std::uint32_t triangles) {
    int told = 0;
    EXPECT_TRUE(terrain::openOrBake(
        dir_ / "scenery", cache, [&](double, const std::string&) { return ++told, true; }, triangles));
    return told > 0;
  };
  EXPECT_TRUE(baked(2000));
  EXPECT_FALSE(baked(2000));
  EXPECT_TRUE(baked(500));
  EXPECT_FALSE(baked(500));
  test::writeFile(dir_ / "scenery/EDNY.btg", test::gridTile({}));
  EXPECT_TRUE(baked(2000));
}

}  // namespace
}  // namespace trimtab
