#include <gdal_priv.h>

#include "core/terrain/bake/source.h"
#include "tests/core/terrain/elevation/rasters.h"
#include "trimtab/terrain/bake/bake.h"
#include "trimtab/terrain/bake/cache.h"

/// Sources that change between one bake and the next.
namespace trimtab::terrain {
namespace {

namespace fs = std::filesystem;

/// A grid of text, whose place on the earth is in a file beside it.
class StaleBake : public ::testing::Test {
 protected:
  StaleBake() {
    std::string text = "ncols 300\nnrows 260\nxllcorner 500000\nyllcorner 5500000\ncellsize 30\n";
    for (int r = 0; r < 260; ++r)
      for (int c = 0; c < 300; ++c)
        text += std::to_string(test::roughGround(c, r)) + (c + 1 < 300 ? ' ' : '\n');
    test::writeFile(source_, text);
    place(32);
    options_.sources = {source_};
    options_.maxError = Metres{20};
    options_.output = dir_ / "db";
  }
  void place(int zone) {
    OGRSpatialReference crs;
    crs.importFromEPSG(32600 + zone);
    char* text = nullptr;
    crs.exportToWkt(&text);
    test::writeFile(dir_ / "ground.prj", text);
    CPLFree(text);
    fs::last_write_time(dir_ / "ground.prj", fs::file_time_type::clock::now() + std::chrono::seconds(zone));
  }
  /// As if the folder's work was begun with the sources as they are now.
  void forgive() const { test::writeFile(dir_ / ".db.work/recipe.json", stampedRecipe(options_, {source_})); }

  test::ScratchDir dir_;
  fs::path source_ = dir_ / "ground.asc";
  BakeOptions options_;
};

TEST_F(StaleBake, doesNotGoOnFromAnotherPlaceOnEarth) {
  ASSERT_TRUE(bakePart(options_, 1, 2));
  place(33);
  ASSERT_TRUE(bakePart(options_, 2, 2));
  const auto joined = bakeJoin(options_);
  ASSERT_TRUE(joined);
  EXPECT_EQ(*joined, nullptr);
  EXPECT_NE(toString(joined.findings()).find("missing"), std::string::npos) << toString(joined.findings());
  place(32);
  const auto made = bake(options_);
  ASSERT_TRUE(made) << toString(made.findings());
  EXPECT_EQ(toString(made.findings()).find("goes on"), std::string::npos) << toString(made.findings());
  EXPECT_NEAR((*made)->info().southWest.longitude.value(), 9, 0.2);
  EXPECT_EQ(test::namesIn(dir_.path()), (std::vector<std::string>{"db", "ground.asc", "ground.prj"}));
}

/// What the stamps do not tell: the grid is another for another reason.
TEST_F(StaleBake, doesNotMixGrids) {
  ASSERT_TRUE(bakePart(options_, 1, 2));
  place(33);
  forgive();
  const auto pieces = test::namesIn(dir_ / ".db.work/pieces");
  for (const auto& refused : {bakePart(options_, 2, 2).findings(), bakeJoin(options_).findings()}) {
    const std::string said = toString(refused);
    for (const char* word : {"longitude 15.0", "longitude 9.0", "part 1 of 2", "left as they are"})
      EXPECT_NE(said.find(word), std::string::npos) << word << ": " << said;
  }
  EXPECT_EQ(test::namesIn(dir_ / ".db.work/pieces"), pieces);
  // Alone it begins anew, to the bytes of one that found nothing.
  const auto made = bake(options_);
  ASSERT_TRUE(made) << toString(made.findings());
  EXPECT_EQ(toString(made.findings()).find("goes on"), std::string::npos) << toString(made.findings());
  options_.output = dir_ / "fresh";
  ASSERT_TRUE(bake(options_));
  for (const std::string& name : test::namesIn(dir_ / "fresh"))
    EXPECT_TRUE(test::readFile(dir_ / "db" / name) == test::readFile(dir_ / "fresh" / name)) << name;
}

TEST_F(StaleBake, isNotOpenedFromACacheOfOtherFiles) {
  const auto opened = [&](const fs::path& source) {
    const auto made = openOrBake(source, dir_ / "cache", {});
    EXPECT_TRUE(made) << toString(made.findings());
    return made ? (*made)->info().southWest.longitude.value() : 0;
  };
  EXPECT_NEAR(opened(source_), 9, 0.2);
  place(33);
  EXPECT_NEAR(opened(source_), 15, 0.2);
  EXPECT_EQ(test::namesIn(dir_ / "cache").size(), 2u);
  // Of a virtual raster the files that it is made of, and theirs.
  const fs::path all = dir_ / "all.vrt";
  GDALAllRegister();
  GDALDataset* data = GDALDataset::Open(source_.c_str(), GDAL_OF_RASTER);
  ASSERT_NE(data, nullptr);
  GDALClose(GetGDALDriverManager()->GetDriverByName("VRT")->CreateCopy(all.c_str(), data, 0, nullptr, nullptr,
                                                                       nullptr));
  GDALClose(data);
  opened(all);
  EXPECT_EQ(test::namesIn(dir_ / "cache").size(), 3u);
  for (const fs::path& changed : {source_, dir_ / "ground.prj"}) {
    const auto before = stampsOf(std::span(&all, 1));
    fs::last_write_time(changed, fs::last_write_time(changed) + std::chrono::seconds(99));
    EXPECT_NE(stampsOf(std::span(&all, 1)), before) << changed;
  }
  opened(all);
  EXPECT_EQ(test::namesIn(dir_ / "cache").size(), 4u);
}

}  // namespace
}  // namespace trimtab::terrain
