#include "made_cdb.h"
#include "trimtab/terrain/cdb/catalogue.h"
#include "trimtab/terrain/elevation/source.h"
#include "trimtab/terrain/ground/imagery.h"

/// Tiles of elevation and imagery, and what stands in the way of them. What no real data beside the checkout
/// has (zones, elevation finer than LC01, Metadata) is made here.
namespace trimtab::terrain {
namespace {

using test::MadeCdb;
namespace fs = std::filesystem;

TEST(CdbName, saysWhereATileIs) {
  struct Case {
    const char* name;
    double west, south, width, height;
    int side;
  };
  for (const Case& c : {Case{"N32W118_D001_S001_T001_L00_U0_R0", -118, 32, 1, 1, 1024},
                        Case{"n32w118_d004_s001_t001_lc09_u0_r0", -118, 32, 1, 1, 2},
                        Case{"S34E018_D001_S001_T001_L02_U3_R1", 18.25, -33.25, 0.25, 0.25, 1024},
                        Case{"N50E010_D001_S001_T001_L01_U0_R1", 11, 50, 1, 0.5, 1024},
                        Case{"N72E012_D001_S001_T001_L00_U0_R0", 12, 72, 3, 1, 1024},
                        Case{"S90W180_D001_S001_T001_L00_U0_R0", -180, -90, 12, 1, 1024},
                        Case{"S51W060_D001_S001_T001_LC01_U0_R0", -60, -51, 2, 1, 512}}) {
    const auto read = cdbNameOf(c.name);
    ASSERT_TRUE(read) << c.name;
    const CdbExtent is = read->tile.extent();
    EXPECT_EQ(is.west, c.west) << c.name;
    EXPECT_EQ(is.south, c.south) << c.name;
    EXPECT_EQ(is.width, c.width) << c.name;
    EXPECT_EQ(is.height, c.height) << c.name;
    EXPECT_EQ(read->tile.side(), c.side) << c.name;
    EXPECT_EQ(read->rest, "");
  }
  EXPECT_EQ(cdbNameOf("N32W118_D300_S001_T001_L00_U0_R0_AL015_000_hut")->rest, "_AL015_000_hut");
  for (int south = -90; south < 90; ++south) EXPECT_EQ(cdbCellWidth(south), MadeCdb::widthAt(south)) << south;
}

TEST(CdbName, refusesWhatIsNone) {
  for (const char* name :
       {"", "N32W118", "N32W118_D001_S001_T001_L24_U0_R0", "N32W118_D001_S001_T001_LC11_U0_R0",
        "N32W118_D001_S001_T001_LC00_U0_R0", "N32W118_D001_S001_T001_L01_U2_R0",
        "N32W118_D001_S001_T001_L01_U0_R2", "N32W118_D001_S001_T001_LC01_U1_R0",
        "N91W118_D001_S001_T001_L00_U0_R0", "N32W181_D001_S001_T001_L00_U0_R0",
        "N32E180_D001_S001_T001_L00_U0_R0", "N32W118_D1_S001_T001_L00_U0_R0", "N32W118_D001_S001_T001_L00_U0",
        "X32W118_D001_S001_T001_L00_U0_R0", "N32W118_D001_S001_T001_L00_U99999999999_R0"})
    EXPECT_FALSE(cdbNameOf(name)) << name;
}

class CdbRasters : public ::testing::Test {
 protected:
  static CdbTile tile(int level, int up = 0, int right = 0) { return {40, 7, 1, 1, 1, level, up, right}; }
  /// Writes a tile of one height.
  fs::path flat(const CdbTile& t, double height) const {
    return cdb_.heights(t, [height](int, int) { return height; });
  }
  std::vector<std::string> shown(int set = CdbSet::kElevation) {
    const auto cdb = openCdb(dir_.path());
    EXPECT_TRUE(cdb) << toString(cdb.findings());
    const auto files = cdbRasters(*cdb, set);
    said_ = toString(cdb.findings()) + toString(files.findings());
    std::vector<std::string> names;
    for (const fs::path& file : *files) names.push_back(file.filename().string().substr(23));
    return names;
  }
  /// Returns the height that all files together have at a place that is a post.
  double heightAt(const std::vector<fs::path>& sources, double longitude, double latitude) {
    const auto elevation = openElevation(sources);
    EXPECT_TRUE(elevation) << toString(elevation.findings());
    if (!elevation) return NAN;
    said_ = toString(elevation.findings());
    const PostGrid& posts = (*elevation)->posts();
    const double row = posts.rowOf(latitude), column = posts.columnOf(longitude);
    EXPECT_NEAR(row, std::round(row), 1e-6);
    EXPECT_NEAR(column, std::round(column), 1e-6);
    std::vector<float> heights(posts.columns);
    EXPECT_TRUE((*elevation)->readRows(static_cast<std::uint32_t>(std::lround(row)), 1, heights));
    return double{heights[static_cast<std::size_t>(std::lround(column))]};
  }

  test::ScratchDir dir_;
  MadeCdb cdb_{dir_ / "Root"};
  std::string said_;
};

TEST_F(CdbRasters, aFinerLevelTakesThePlaceOfACoarser) {
  for (int level = -10; level <= 0; ++level) flat(tile(level), level);
  EXPECT_EQ(shown(), (std::vector<std::string>{"L00_U0_R0.tif"}));
  for (const auto& [up, right] : {std::pair{0, 0}, {0, 1}, {1, 0}}) flat(tile(1, up, right), 100);
  EXPECT_EQ(shown(),
            (std::vector<std::string>{"L01_U0_R0.tif", "L01_U0_R1.tif", "L01_U1_R0.tif", "L00_U0_R0.tif"}));
  // Four still finer ones fill the last quarter.
  for (const auto& [up, right] : {std::pair{2, 2}, {2, 3}, {3, 2}, {3, 3}}) flat(tile(2, up, right), 200);
  EXPECT_EQ(shown().size(), 7u);
  EXPECT_EQ(said_, "");
}

TEST_F(CdbRasters, aDamagedTileIsNamedAndACoarserOneShowsThere) {
  for (int level = -2; level <= -1; ++level) flat(tile(level), level);
  const fs::path fine = flat(tile(0), 5);
  test::writeFile(fine, test::readFile(fine).substr(0, 6));
  EXPECT_EQ(shown(), (std::vector<std::string>{"LC01_U0_R0.tif"}));
  EXPECT_NE(said_.find("L00_U0_R0.tif"), std::string::npos) << said_;
  // One that its name makes larger than it is would be stretched.
  cdb_.heights(
      tile(0), [](int, int) { return 5.0; }, [](test::RasterRecipe& r) { r.columns = r.rows = 1000; });
  EXPECT_EQ(shown(), (std::vector<std::string>{"LC01_U0_R0.tif"}));
  EXPECT_NE(said_.find("1000 x 1000"), std::string::npos) << said_;
}

TEST_F(CdbRasters, postsStandAtTheSouthWestCornersOfEachZone) {
  const auto value = [](int c, int r) { return 3.0 * c + 7.0 * r; };
  const CdbTile wide{52, 10, 1, 1, 1, -3, 0, 0};
  cdb_.heights(wide, value);
  // 128 posts over one degree of latitude and two of longitude.
  EXPECT_EQ(heightAt({dir_.path()}, 10, 52), 0);
  EXPECT_EQ(heightAt({dir_.path()}, 10 + 5 * 2.0 / 128, 52 + 9.0 / 128), 3 * 5 + 7 * 9);
  EXPECT_EQ(heightAt({dir_ / "Root"}, 10 + 127 * 2.0 / 128, 52 + 127.0 / 128), 10 * 127);
  EXPECT_EQ(heightAt({dir_ / "Root" / "Tiles"}, 10, 52 + 1.0 / 128), 7);
}

TEST_F(CdbRasters, theFinestIsUsedWhereItIs) {
  flat(tile(-3), 10);
  flat(tile(1, 1, 0), 20);
  const double fine = 1.0 / 2048;
  EXPECT_EQ(heightAt({dir_.path()}, 7 + 500 * fine, 40.5 + 500 * fine), 20);
  EXPECT_EQ(heightAt({dir_.path()}, 7.75, 40.5), 10);
  EXPECT_EQ(heightAt({dir_.path()}, 7.25, 40.125), 10);
}

TEST_F(CdbRasters, aNameCountsMoreThanAGeoreference) {
  cdb_.heights(
      tile(-3), [](int c, int r) { return c + 40.0 * r; }, [](test::RasterRecipe& r) { r.west += 1; });
  EXPECT_EQ(heightAt({dir_.path()}, 7 + 3.0 / 128, 40 + 2.0 / 128), 83);
  EXPECT_NE(said_.find("georeference"), std::string::npos) << said_;
  // None at all is no contradiction.
  cdb_.heights(
      tile(-3), [](int c, int r) { return c + 40.0 * r; }, [](test::RasterRecipe& r) { r.placed = false; });
  EXPECT_EQ(heightAt({dir_.path()}, 7 + 3.0 / 128, 40 + 2.0 / 128), 83);
  EXPECT_EQ(said_.find("georeference"), std::string::npos) << said_;
}

TEST_F(CdbRasters, imageryGoesWhereItsNameSays) {
  CdbTile picture{40, 7, 4, 1, 1, -3, 0, 0};
  test::RasterRecipe recipe = test::anyColours(128, 128);
  recipe.value = [](int c, int r, int) { return c == 20 && r == 100 ? 250 : 10; };
  recipe.west = 50;
  recipe.north = 3;
  recipe.step = 1.0 / 128;
  test::writeRaster(cdb_.fileOf(picture, ".tif"), recipe);
  const PostGrid posts{7 + 0.5 / 128, 40 + 0.5 / 128, 1.0 / 128, 1.0 / 128, 128, 128};
  const auto over = imageryOver(dir_.path(), posts);
  ASSERT_TRUE(over) << toString(over.findings());
  const auto rgba = readImagery(*over, posts, {});
  ASSERT_TRUE(rgba) << toString(rgba.findings());
  const auto redAt = [&](int c, int r) { return (*rgba)[4 * static_cast<std::size_t>(128 * r + c)]; };
  EXPECT_EQ(redAt(20, 27), 250);
  EXPECT_EQ(redAt(21, 27), 10);
  EXPECT_EQ(redAt(20, 28), 10);
}

TEST_F(CdbRasters, namesWhatCannotBeOfIt) {
  flat(tile(-3), 1);
  const fs::path good = flat(tile(-4), 1);
  fs::copy(good, good.parent_path() / "heights.tif");
  // Another cell's name, another level's, and a cell that stands across two of its zone.
  fs::copy(good, good.parent_path() / "N41E007_D001_S001_T001_LC04_U0_R0.tif");
  fs::copy(good, good.parent_path() / "N40E007_D001_S001_T001_L00_U0_R0.tif");
  flat({52, 11, 1, 1, 1, -3, 0, 0}, 1);
  EXPECT_EQ(shown(), (std::vector<std::string>{"LC03_U0_R0.tif"}));
  for (const char* name : {"heights.tif", "N41E007_D001", "N40E007_D001_S001_T001_L00", "N52E011"})
    EXPECT_NE(said_.find(name), std::string::npos) << name << "\n" << said_;
}

TEST_F(CdbRasters, areNoneInOtherFolders) {
  EXPECT_FALSE(isCdb(dir_.path()));
  fs::create_directories(dir_ / "Root" / "Tiles" / "elsewhere");
  EXPECT_FALSE(isCdb(dir_.path()));
  flat(tile(-3), 1);
  EXPECT_TRUE(isCdb(dir_.path()));
  EXPECT_TRUE(isCdb(dir_ / "Root"));
  EXPECT_TRUE(isCdb(dir_ / "Root/"));
  EXPECT_TRUE(isCdb(dir_ / "Root" / "Tiles"));
  EXPECT_FALSE(isCdb(dir_ / "Root" / "Tiles" / "N40"));
  // A second one: which is meant?
  MadeCdb(dir_ / "Other").heights(tile(-3), [](int, int) { return 1.0; });
  const auto both = openCdb(dir_.path());
  ASSERT_FALSE(both);
  EXPECT_NE(toString(both.findings()).find("Other, Root"), std::string::npos);
  test::writeFile(dir_ / "dem.tif", "heights");
  EXPECT_FALSE(isCdb(dir_.path())) << "a folder with data of its own";
}

class CdbVersions : public CdbRasters {
 protected:
  CdbVersions() {
    for (const auto& [name, height] : {std::pair{"Root", 1.0}, {"old", 2.0}, {"oldest", 3.0}}) {
      const MadeCdb version(dir_ / name);
      version.heights(tile(-3), [h = height](int, int) { return h; });
      if (height > 1) version.heights({40, 8, 1, 1, 1, -3, 0, 0}, [h = height](int, int) { return h; });
      if (height > 2) version.heights({40, 9, 1, 1, 1, -3, 0, 0}, [h = height](int, int) { return h; });
      fs::create_directories(dir_ / name / "Metadata");
    }
  }
  void previous(const std::string& of, const std::string& name) const {
    test::writeFile(dir_ / of / "Metadata" / "Version.xml",
                    "<?xml version=\"1.0\"?>\n<Version xmlns=\"http://www.opengis.net/cdb/1.1/Version\">\n"
                    "<PreviousIncrementalRootDirectory name=\"" +
                        name + "\"/></Version>\n");
  }
  std::array<double, 3> heights() {
    std::array<double, 3> all{};
    for (std::size_t k = 0; k < 3; ++k)
      all[k] = heightAt({dir_ / "Root"}, 7.5 + static_cast<double>(k), 40.5);
    return all;
  }
};

TEST_F(CdbVersions, replaceOneAnother) {
  previous("Root", "..\\old");
  previous("old", (dir_ / "oldest").string());
  EXPECT_EQ(heights(), (std::array{1.0, 2.0, 3.0}));
}

TEST_F(CdbVersions, mayNameEachOtherAndWhatIsNotThere) {
  previous("Root", "../old");
  previous("old", "../Root");
  const auto cdb = openCdb(dir_ / "Root");
  ASSERT_TRUE(cdb);
  EXPECT_EQ(cdb->versions.size(), 2u);
  EXPECT_TRUE(cdb.findings().empty()) << toString(cdb.findings());
  previous("old", "../gone");
  const auto other = openCdb(dir_ / "Root");
  ASSERT_TRUE(other);
  EXPECT_NE(toString(other.findings()).find("../gone"), std::string::npos);
  test::writeFile(dir_ / "Root" / "Metadata" / "Version.xml", "<Version><Previous");
  const auto damaged = openCdb(dir_ / "Root");
  ASSERT_TRUE(damaged);
  EXPECT_EQ(damaged->versions.size(), 1u);
  EXPECT_NE(toString(damaged.findings()).find("Version.xml"), std::string::npos);
}

TEST_F(CdbVersions, aConfigurationSaysTheirOrder) {
  previous("Root", "../oldest");
  test::writeFile(
      dir_ / "Root" / "Metadata" / "Configuration.xml",
      "<?xml version=\"1.0\"?>\n<Configuration xmlns=\"http://www.opengis.net/cdb/1.0/Configuration\">\n"
      "<Comment>two</Comment><Version><Folder path=\"../old\"/></Version>"
      "<Version><Folder path=\".\"/></Version></Configuration>\n");
  const auto cdb = openCdb(dir_ / "Root");
  ASSERT_TRUE(cdb);
  EXPECT_EQ(cdb->versions.size(), 2u);
  EXPECT_EQ(heightAt({dir_ / "Root"}, 7.5, 40.5), 2);
}

}  // namespace
}  // namespace trimtab::terrain
