#include <cmath>
#include <set>

#include "scenery_tiles.h"

namespace trimtab {
namespace {

namespace fs = std::filesystem;
using terrain::bucketAt;
using terrain::bucketOf;

std::vector<std::string> namesOf(const terrain::Scenery& scenery) {
  std::vector<std::string> names;
  for (const auto& tile : scenery.tiles) names.push_back(tile.name + (tile.airport ? " airport" : ""));
  return names;
}

class SceneryFolder : public ::testing::Test {
 protected:
  SceneryFolder() {
    fs::create_directories(dir_ / "Terrain/e000n50");
    folder_ = dir_ / "Terrain/e000n50";
    test::writeFile(folder_ / "3056410.btg.gz", test::gzipped(test::gridTile({})));
    test::writeFile(folder_ / "3056411.btg", test::gridTile({}));
    test::writeFile(folder_ / "EDNY.btg.gz", test::gzipped(test::gridTile({})));
  }
  void list(const std::string& text) { test::writeFile(folder_ / "3056410.stg", text); }

  test::ScratchDir dir_;
  fs::path folder_;
};

TEST_F(SceneryFolder, readsEveryTileWhereThereIsNoList) {
  const auto scenery = terrain::readScenery(dir_.path());
  ASSERT_TRUE(scenery) << toString(scenery.findings());
  EXPECT_EQ(namesOf(*scenery), (std::vector<std::string>{"3056410", "3056411", "EDNY airport"}));
  EXPECT_TRUE(scenery.findings().empty());
}

TEST_F(SceneryFolder, readsWhatItsListsNameAndNothingElse) {
  list(
      "# a comment\n"
      "OBJECT_BASE 3056410.btg\r\n"
      "OBJECT EDNY.btg\n"
      "OBJECT_SHARED Models/Airport/windsock.xml 7.1 50.7 61.2 0.00\n"
      "OBJECT_STATIC church.ac 7.1 50.7 61.2 0.00\n"
      "OBJECT_SIGN {@L}A 7.1 50.7 10.0 90 2\n"
      "\n"
      "OBJECT_BASE 3056410.btg\n");
  const auto scenery = terrain::readScenery(dir_.path());
  ASSERT_TRUE(scenery);
  EXPECT_EQ(namesOf(*scenery), (std::vector<std::string>{"3056410", "EDNY airport"}));
  EXPECT_TRUE(scenery.findings().empty()) << toString(scenery.findings());
  EXPECT_EQ(terrain::sceneryFiles(dir_.path())->size(), 3U);
}

TEST_F(SceneryFolder, reportsTilesThatAListNamesInVain) {
  list("OBJECT_BASE 3056410.btg\nOBJECT LOST.btg\n");
  const auto scenery = terrain::readScenery(folder_);
  ASSERT_TRUE(scenery);
  EXPECT_EQ(scenery->missing, std::vector<std::string>{"LOST.btg"});
  ASSERT_EQ(scenery.findings().size(), 1U);
  EXPECT_EQ(scenery.findings()[0].severity, Severity::warning);
  EXPECT_TRUE(scenery.findings()[0].where.ends_with("3056410.stg:2"));
}

TEST_F(SceneryFolder, opensNothingOutsideTheListsOwnFolder) {
  test::writeFile(dir_ / "outside.btg", test::gridTile({}));
  list("OBJECT_BASE 3056410.btg\nOBJECT ../../outside.btg\nOBJECT " + (dir_ / "outside.btg").string() +
       "\nOBJECT\nOBJECT notes.txt\n");
  const auto scenery = terrain::readScenery(folder_);
  ASSERT_TRUE(scenery);
  EXPECT_EQ(scenery->tiles.size(), 1U);
  EXPECT_EQ(scenery.findings().size(), 4U) << toString(scenery.findings());
}

TEST_F(SceneryFolder, leavesTheOthersWhenATileIsBroken) {
  test::writeFile(folder_ / "3056411.btg", "no tile");
  const auto scenery = terrain::readScenery(folder_);
  ASSERT_TRUE(scenery);
  EXPECT_EQ(namesOf(*scenery), (std::vector<std::string>{"3056410", "EDNY airport"}));
  EXPECT_TRUE(test::tellsWhy(scenery.findings()));
  for (const char* name : {"3056410.btg.gz", "EDNY.btg.gz"})
    test::writeFile(folder_ / name, "\x1f\x8b broken");
  const auto none = terrain::readScenery(folder_);
  EXPECT_FALSE(none);
  EXPECT_EQ(none.findings().size(), 3U);
}

TEST_F(SceneryFolder, takesASingleTileOrListToo) {
  list("OBJECT EDNY.btg\n");
  EXPECT_EQ(namesOf(*terrain::readScenery(folder_ / "3056410.stg")),
            std::vector<std::string>{"EDNY airport"});
  EXPECT_EQ(namesOf(*terrain::readScenery(folder_ / "3056411.btg")), std::vector<std::string>{"3056411"});
}

TEST_F(SceneryFolder, isKnownForScenery) {
  EXPECT_TRUE(terrain::isScenery(dir_.path()));
  EXPECT_TRUE(terrain::isScenery(folder_ / "3056411.btg"));
  EXPECT_TRUE(terrain::isScenery(folder_ / "3056410.btg.gz"));
  EXPECT_FALSE(terrain::isScenery(folder_ / "absent.btg"));
  EXPECT_FALSE(terrain::isScenery(dir_ / "absent"));
  fs::create_directory(dir_ / "other");
  test::writeFile(dir_ / "other/n50.hgt", "");
  EXPECT_FALSE(terrain::isScenery(dir_ / "other"));
  EXPECT_FALSE(terrain::readScenery(dir_ / "other"));
  EXPECT_FALSE(terrain::readScenery(dir_ / "absent"));
}

TEST_F(SceneryFolder, stopsWhenToldTo) {
  EXPECT_FALSE(terrain::readScenery(folder_, [](double, const std::string&) { return false; }));
}

TEST(Bucket, ofThePublishedExampleIsWhereItShouldBe) {
  const auto bucket = bucketOf(3105386);
  EXPECT_EQ(bucket.west, Degrees{9.5});
  EXPECT_EQ(bucket.east, Degrees{9.75});
  EXPECT_EQ(bucket.south, Degrees{47.625});
  EXPECT_EQ(bucket.north, Degrees{47.75});
  EXPECT_EQ(bucketAt(Degrees{47.67}, Degrees{9.51}).index, 3105386);
}

TEST(Bucket, holdsThePlaceItIsFoundFor) {
  for (double lat = -90; lat <= 90; lat += 0.37)
    for (double lon = -180; lon <= 180; lon += 0.53) {
      const auto bucket = bucketAt(Degrees{lat}, Degrees{lon});
      ASSERT_GE(bucket.index, 0) << lat << ' ' << lon;
      const double inside = wrapped180(Degrees{lon} - bucket.west).value();
      EXPECT_LE(bucket.south.value(), lat);
      EXPECT_GE(bucket.north.value(), lat);
      EXPECT_GE(inside, -1e-9) << lat << ' ' << lon;
      EXPECT_LE(inside, (bucket.east - bucket.west).value() + 1e-9) << lat << ' ' << lon;
      EXPECT_EQ(bucketOf(bucket.index).west, bucket.west);
    }
}

TEST(Bucket, isAsWideAsItsLatitudeAsks) {
  const std::pair<double, double> table[] = {
      {0.5, 0.125}, {21.9, 0.125}, {22.1, 0.25}, {61.9, 0.25}, {62.1, 0.5}, {75.9, 0.5}, {76.1, 1},
      {82.9, 1},    {83.1, 2},     {85.9, 2},    {86.1, 4},    {88.9, 4},   {89.1, 12}};
  for (const auto& [latitude, width] : table)
    for (const double side : {1.0, -1.0}) {
      const auto bucket = bucketAt(Degrees{side * latitude}, Degrees{-97.3});
      EXPECT_EQ((bucket.east - bucket.west).value(), width) << side * latitude;
    }
}

TEST(Bucket, isNoneForWhatIsNoPlace) {
  const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, infinity, -infinity, 91.0})
    EXPECT_EQ(bucketAt(Degrees{bad}, Degrees{0}).index, -1);
  EXPECT_EQ(bucketAt(Degrees{0}, Degrees{nan}).index, -1);
  for (const long bad : {-1L, 360L << 14, (100L << 14) | (180L << 6), (100L << 14) | (140L << 6) | 4})
    EXPECT_EQ(bucketOf(bad).index, -1) << bad;
}

TEST(MaterialColour, tellsWaterWoodsFieldsAndTownsApart) {
  const auto blue = [](const char* m) {
    const auto c = terrain::materialColour(m);
    return c[2] > c[0] && c[2] > c[1];
  };
  const auto green = [](const char* m) {
    const auto c = terrain::materialColour(m);
    return c[1] > c[0] && c[1] > c[2];
  };
  for (const char* water : {"Ocean", "Lake", "Stream", "Canal", "Watercourse"})
    EXPECT_TRUE(blue(water)) << water;
  for (const char* plants :
       {"EvergreenForest", "DeciduousForest", "MixedForest", "Scrub", "Rice", "Grassland"})
    EXPECT_TRUE(green(plants)) << plants;
  EXPECT_EQ(terrain::materialColour("evergreenforest"), terrain::materialColour("EvergreenForest"));
  EXPECT_NE(terrain::materialColour("pa_tiedown"), terrain::materialColour("pc_tiedown"));
  const auto unknown = terrain::materialColour("NeverHeardOf");
  EXPECT_EQ(unknown[0], unknown[1]);
  EXPECT_EQ(unknown, terrain::materialColour(""));
}

}  // namespace
}  // namespace trimtab
