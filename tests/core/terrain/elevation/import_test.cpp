#include "tests/core/terrain/elevation/read_elevation.h"

#include <GeographicLib/UTMUPS.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include "rasters.h"

namespace trimtab::terrain {
namespace {

namespace fs = std::filesystem;

Result<test::Imported> importOne(const fs::path& file) {
  const std::vector<fs::path> sources{file};
  return test::importElevation(sources);
}
float at(const HeightGrid& grid, std::uint32_t rowFromNorth, std::uint32_t column) {
  return grid.heights[std::size_t{grid.posts.rows - 1 - rowFromNorth} * grid.posts.columns + column];
}
bool speaksOf(const Findings& findings, const std::string& word) {
  return toString(findings).find(word) != std::string::npos;
}
std::pair<float, float> extent(const HeightGrid& grid) {
  const auto [low, high] = std::minmax_element(grid.heights.begin(), grid.heights.end());
  return {*low, *high};
}

TEST(ImportElevation, readsEveryPostOfAnHgt) {
  TRIMTAB_NEEDS_SHARED("data/dem-srtm3-everest");
  const fs::path file = test::sharedDir() / "data/dem-srtm3-everest/N27E086.hgt";
  const auto imported = importOne(file);
  ASSERT_TRUE(imported) << toString(imported.findings());
  const HeightGrid& grid = imported->grid;
  ASSERT_EQ(grid.posts.columns, 1201u);
  ASSERT_EQ(grid.posts.rows, 1201u);
  EXPECT_NEAR(grid.posts.west, 86, 1e-9);
  EXPECT_NEAR(grid.posts.south, 27, 1e-9);
  EXPECT_NEAR(grid.posts.longitude(1200), 87, 1e-9);
  EXPECT_NEAR(grid.posts.latitude(1200), 28, 1e-9);
  EXPECT_EQ(imported->voidsFilled, 0u);
  // The file is big-endian 16-bit rows from the north.
  const std::string raw = test::readFile(file);
  for (std::uint32_t r = 0; r < 1201; ++r)
    for (std::uint32_t c = 0; c < 1201; ++c) {
      const std::size_t k = (std::size_t{r} * 1201 + c) * 2;
      const auto high = static_cast<std::uint8_t>(raw[k]), low = static_cast<std::uint8_t>(raw[k + 1]);
      ASSERT_EQ(at(grid, r, c), static_cast<std::int16_t>(high << 8 | low));
    }
}

struct Known {
  const char* file;
  std::uint64_t voids;
  float low, high;
  float between = 0;  ///< what a surface through posts that were moved may differ
};
class ImportRealData : public ::testing::TestWithParam<Known> {};

TEST_P(ImportRealData, countsVoidsAndKeepsExtremes) {
  const Known& known = GetParam();
  const std::string file = std::string("data/") + known.file;
  TRIMTAB_NEEDS_SHARED(file);
  const auto imported = importOne(test::sharedDir() / file);
  ASSERT_TRUE(imported) << toString(imported.findings());
  EXPECT_EQ(imported->voidsFilled, known.voids);
  const auto [low, high] = extent(imported->grid);
  EXPECT_NEAR(low, known.low, known.between);
  EXPECT_NEAR(high, known.high, known.between);
}
INSTANTIATE_TEST_SUITE_P(
    Files, ImportRealData,
    ::testing::Values(Known{"dem-srtm3-everest/N27E086.hgt", 0, 192, 8840},
                      Known{"dem-osgearth-everest-voids/mt_everest_90m.tif", 130953, 192, 8642},
                      Known{"dem-osgearth-fuji/mt_fuji_90m.tif", 2437, -16, 3742},
                      Known{"dem-dted1-saotome/n00_e006_3arc_v2.dt1", 4072, -7, 1979},
                      Known{"dem-dted-derived/n35_e138_negatives_voids.dt1", 2437, -16, 3742},
                      Known{"dem-dted-derived/n27_e086_from_srtm3.dt0", 0, 197, 8520},
                      Known{"dem-image-craterlake/craterlake-elev-16bit-30m.tif", 39489, 1289, 1880},
                      Known{"dem-30m-bigtujunga/bigtujunga.tif", 0, 315, 2295, 4}));

TEST(ImportElevation, readsDtedLikeTheFileItWasMadeFrom) {
  TRIMTAB_NEEDS_SHARED("data/dem-dted-derived");
  const auto dted = importOne(test::sharedDir() / "data/dem-dted-derived/n27_e086_from_srtm3.dt1");
  const auto hgt = importOne(test::sharedDir() / "data/dem-srtm3-everest/N27E086.hgt");
  ASSERT_TRUE(dted && hgt);
  EXPECT_EQ(dted->grid.heights, hgt->grid.heights);
  EXPECT_NEAR(dted->grid.posts.west, hgt->grid.posts.west, 1e-9);
}

TEST(ImportElevation, refusesAFlippedBitInDted) {
  TRIMTAB_NEEDS_SHARED("data/dem-dted1-saotome");
  test::ScratchDir dir;
  std::string bytes = test::readFile(test::sharedDir() / "data/dem-dted1-saotome/n00_e006_3arc_v2.dt1");
  bytes[2000000] = static_cast<char>(bytes[2000000] ^ 0x10);
  test::writeFile(dir / "n00_e006.dt1", bytes);
  const auto imported = importOne(dir / "n00_e006.dt1");
  ASSERT_FALSE(imported);
  EXPECT_TRUE(speaksOf(imported.findings(), "n00_e006.dt1"));
  EXPECT_TRUE(speaksOf(imported.findings(), "checksum")) << toString(imported.findings());
}

TEST(ImportElevation, putsUtmGroundWhereGeographicLibDoes) {
  TRIMTAB_NEEDS_SHARED("data/dem-30m-bigtujunga");
  const fs::path file = test::sharedDir() / "data/dem-30m-bigtujunga/bigtujunga.tif";
  const auto imported = importOne(file);
  ASSERT_TRUE(imported);
  const HeightGrid& grid = imported->grid;
  GDALDataset* data = GDALDataset::Open(file.c_str());
  ASSERT_NE(data, nullptr);
  std::vector<float> raw(1197 * 643);
  ASSERT_EQ(data->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, 1197, 643, raw.data(), 1197, 643, GDT_Float32, 0,
                                             0, nullptr),
            CE_None);
  GDALClose(data);
  // Mean square difference at pixel centres, as they are and shifted by half a pixel: the true place is the
  // best.
  const auto misfit = [&](double east, double north) {
    double sum = 0;
    int count = 0;
    for (int r = 20; r < 620; r += 7)
      for (int c = 20; c < 1170; c += 11) {
        double latitude, longitude;
        GeographicLib::UTMUPS::Reverse(11, true, 376313.655454263498541 + 30 * (c + 0.5 + east),
                                       3807917.827628375496715 - 30 * (r + 0.5 - north), latitude, longitude);
        const double x = (longitude - grid.posts.west) / grid.posts.stepLongitude,
                     y = (latitude - grid.posts.south) / grid.posts.stepLatitude;
        const auto i = static_cast<std::uint32_t>(x), j = static_cast<std::uint32_t>(y);
        const double u = x - i, v = y - j;
        const auto h = [&](std::uint32_t row, std::uint32_t column) {
          return static_cast<double>(grid.heights[std::size_t{row} * grid.posts.columns + column]);
        };
        const double found = (h(j, i) * (1 - u) + h(j, i + 1) * u) * (1 - v) +
                             (h(j + 1, i) * (1 - u) + h(j + 1, i + 1) * u) * v;
        const double difference =
            found -
            static_cast<double>(raw[static_cast<std::size_t>(r) * 1197 + static_cast<std::size_t>(c)]);
        sum += difference * difference;
        ++count;
      }
    return std::sqrt(sum / count);
  };
  const double placed = misfit(0, 0);
  EXPECT_LT(placed, 2.0);
  for (const auto& [east, north] : {std::pair{0.25, 0.0}, {-0.25, 0.0}, {0.0, 0.25}, {0.0, -0.25}})
    EXPECT_GT(misfit(east, north), 1.3 * placed);
}

TEST(ImportElevation, toleratesCorruptGeoKeysWithANote) {
  TRIMTAB_NEEDS_SHARED("data/dem-image-sba");
  const auto imported = importOne(test::sharedDir() / "data/dem-image-sba/sba_elev32_wgs84_512x512.tif");
  ASSERT_TRUE(imported);
  EXPECT_TRUE(speaksOf(imported.findings(), "sba_elev32_wgs84_512x512.tif"));
  EXPECT_TRUE(speaksOf(imported.findings(), "corrupt"));
  EXPECT_NEAR(imported->grid.posts.west, -119.8337 + 0.5 * 3.02734375e-05, 1e-9);
}

TEST(ImportElevation, readsNad83AsItStands) {
  TRIMTAB_NEEDS_SHARED("data/dem-image-sba");
  const auto imported = importOne(test::sharedDir() / "data/dem-image-sba/elev32_nad83_512x512.tif");
  ASSERT_TRUE(imported) << toString(imported.findings());
  EXPECT_EQ(imported->grid.posts.columns, 512u);
  EXPECT_NEAR(imported->grid.posts.west, -121.0001851852 + 0.5 * 0.001953848379786, 1e-8);
}

class ImportMadeData : public ::testing::Test {
 protected:
  Result<test::Imported> import(const test::RasterRecipe& recipe) {
    return importOne(test::writeRaster(dir_ / "made.tif", recipe));
  }
  test::ScratchDir dir_;
};

TEST_F(ImportMadeData, takesPixelCentresForAreaAndTiePointsForPoint) {
  test::RasterRecipe recipe;
  auto area = import(recipe);
  ASSERT_TRUE(area);
  EXPECT_NEAR(area->grid.posts.west, 10.0005, 1e-12);
  EXPECT_NEAR(area->grid.posts.latitude(64), 49.9995, 1e-12);
  // The tie point goes into the file as it is, and so stands for the first post itself.
  CPLSetConfigOption("GTIFF_POINT_GEO_IGNORE", "TRUE");
  recipe.point = true;
  test::writeRaster(dir_ / "point.tif", recipe);
  CPLSetConfigOption("GTIFF_POINT_GEO_IGNORE", nullptr);
  auto point = importOne(dir_ / "point.tif");
  ASSERT_TRUE(point);
  EXPECT_NEAR(point->grid.posts.west, 10.0, 1e-12);
  EXPECT_NEAR(point->grid.posts.latitude(64), 50.0, 1e-12);
}

TEST_F(ImportMadeData, turnsFeetToMetres) {
  for (const auto& [unit, metres] :
       {std::pair{"ft", 0.3048}, {"US survey foot", 1200.0 / 3937}, {"m", 1.0}, {"", 1.0}}) {
    test::RasterRecipe recipe;
    recipe.unit = unit;
    recipe.value = [](int c, int r, int) { return 1000.0 + c + r; };
    const auto imported = import(recipe);
    ASSERT_TRUE(imported);
    EXPECT_NEAR(at(imported->grid, 3, 4), 1007 * metres, 1e-3) << unit;
  }
}

TEST_F(ImportMadeData, keepsNegativeHeightsAndSeaFloors) {
  test::RasterRecipe recipe;
  recipe.value = [](int c, int, int) { return -60.0 * c; };  // to -3,840 m
  const auto imported = import(recipe);
  ASSERT_TRUE(imported);
  EXPECT_EQ(imported->voidsFilled, 0u);
  EXPECT_EQ(extent(imported->grid).first, -3840);
}

TEST_F(ImportMadeData, takesNumbersThatStandApartForVoidsWhateverTheirMetresAre) {
  // Mountains to 8,000 m and a sea floor, in steps of a tenth and of a hundredth of a metre.
  for (const double scale : {0.1, 0.01})
    for (const double sentinel : {-9999.0, -32768.0, 1e30}) {
      test::RasterRecipe recipe;
      recipe.scale = scale;
      recipe.value = [&](int c, int r, int) {
        return c == 5 && r == 6 ? sentinel : std::round((125.0 * c - (r == 9 ? 10.0 : 0.0)) / scale);
      };
      const auto imported = import(recipe);
      ASSERT_TRUE(imported);
      EXPECT_EQ(imported->voidsFilled, 1u) << scale << ", " << sentinel;
      EXPECT_NEAR(extent(imported->grid).second, 8000, 1e-3);
      EXPECT_NEAR(at(imported->grid, 3, 64), 8000, 1e-3);
      EXPECT_NEAR(at(imported->grid, 9, 0), -10, 1e-3);
    }
}

TEST_F(ImportMadeData, keepsHeightsThatAreNumbersOtherFilesHaveForVoids) {
  struct Case {
    const char* name;
    std::optional<double> noData;
    double scale;
    std::function<double(int, int)> metres;
    double number;  ///< of one post
  };
  const auto trench = [](int c, int r) { return 200 - 167 * c - r / 8; };  // to -10,496 m
  const auto hills = [](int c, int r) { return 300 + 0.5 * c + 0.25 * r; };
  const Case cases[] = {
      {"a deep sea with a tag", -32768, 1, trench, -9999},
      {"a deep sea without a tag", {}, 1, trench, -9999},
      {"hills in centimetres", -2147483648.0, 0.01, hills, 32767},
      {"hills in centimetres without a tag", {}, 0.01, hills, 32767},
      {"shallows in centimetres", -2147483648.0, 0.01, [](int c, int r) { return -c - 0.25 * r; }, -9999},
  };
  for (const Case& c : cases) {
    test::RasterRecipe recipe;
    recipe.type = GDT_Int32;
    recipe.noData = c.noData;
    if (c.scale != 1) recipe.scale = c.scale;
    recipe.value = [&](int column, int row, int) {
      return column == 60 && row == 10 ? c.number : std::round(c.metres(column, row) / c.scale);
    };
    const auto imported = import(recipe);
    ASSERT_TRUE(imported) << c.name;
    EXPECT_EQ(imported->voidsFilled, 0u) << c.name;
    EXPECT_NEAR(at(imported->grid, 10, 60), c.number * c.scale, 1e-3) << c.name;
    EXPECT_NEAR(at(imported->grid, 3, 64), c.metres(64, 3), c.scale) << c.name;
    EXPECT_FALSE(speaksOf(imported.findings(), "no-data")) << c.name;
  }
}

TEST_F(ImportMadeData, takesMoreOfANumberThanOfItsLikeForVoidsThatWereResampled) {
  // A hole of -9999 in land, whose border was averaged.
  test::RasterRecipe recipe;
  recipe.value = [](int c, int r, int) {
    const int inside = std::min({c - 20, 40 - c, r - 20, 40 - r});
    return inside >= 2 ? -9999.0 : inside == 1 ? -9500.0 : inside == 0 ? -2300.0 : 250.0;
  };
  const auto imported = import(recipe);
  ASSERT_TRUE(imported);
  EXPECT_EQ(imported->voidsFilled, 21u * 21);
  EXPECT_EQ(extent(imported->grid), (std::pair{250.0f, 250.0f}));
  // The tag names the inner ones; the others are as far from the ground as before.
  recipe.noData = -9999;
  const auto tagged = import(recipe);
  ASSERT_TRUE(tagged);
  EXPECT_EQ(tagged->voidsFilled, 21u * 21);
}

TEST_F(ImportMadeData, catchesVoidsThatNoTagNames) {
  for (const double sentinel :
       {-32767.0, -32768.0, -9999.0, -3.4e38, 1e30, std::numeric_limits<double>::quiet_NaN(),
        std::numeric_limits<double>::infinity()}) {
    test::RasterRecipe recipe;
    recipe.value = [&](int c, int r, int) { return c > 20 && c < 30 && r > 7 && r < 17 ? sentinel : 250.0; };
    const auto imported = import(recipe);
    ASSERT_TRUE(imported) << sentinel;
    EXPECT_EQ(imported->voidsFilled, 81u) << sentinel;
    EXPECT_EQ(extent(imported->grid), (std::pair{250.0f, 250.0f})) << sentinel;
  }
}

TEST_F(ImportMadeData, makesSeaOfAFileOfVoids) {
  test::RasterRecipe recipe;
  recipe.noData = -1;
  recipe.value = [](int, int, int) { return -1; };
  const auto imported = import(recipe);
  ASSERT_TRUE(imported);
  EXPECT_EQ(imported->voidsFilled, 65u * 65);
  EXPECT_EQ(extent(imported->grid).second, 0);
  EXPECT_TRUE(speaksOf(imported.findings(), "voids alone"));
}

TEST_F(ImportMadeData, turnsARasterThatComesFromTheSouth) {
  test::RasterRecipe recipe;
  recipe.value = [](int c, int r, int) { return 100.0 * r + c; };
  recipe.southUp = true;
  const auto south = import(recipe);
  recipe.southUp = false;
  const auto north = import(recipe);
  ASSERT_TRUE(south && north);
  EXPECT_EQ(south->grid.heights, north->grid.heights);
  EXPECT_NEAR(south->grid.posts.south, north->grid.posts.south, 1e-12);
}

TEST_F(ImportMadeData, warpsWithoutMixingVoidsIn) {
  test::RasterRecipe recipe;
  recipe.crs = "EPSG:32652";
  recipe.west = 440000, recipe.north = 4060000, recipe.step = 30;
  recipe.value = [](int c, int r, int) { return c > 20 && c < 40 && r > 20 && r < 40 ? -32767.0 : 500.0; };
  const auto imported = import(recipe);
  ASSERT_TRUE(imported) << toString(imported.findings());
  EXPECT_NEAR(static_cast<double>(imported->voidsFilled), 361, 60);
  for (const float h : imported->grid.heights) ASSERT_NEAR(h, 500, 0.01);
}

struct Bad {
  const char* what;
  std::function<fs::path(const fs::path&)> make;
  const char* says;
};

TEST_F(ImportMadeData, refusesWhatItCannotReadNamingTheFile) {
  const auto recipe = [](auto change) {
    test::RasterRecipe r;
    change(r);
    return r;
  };
  const Bad bad[] = {
      {"absent", [](const fs::path& f) { return f; }, "nothing there"},
      {"noise",
       [](const fs::path& f) {
         test::writeFile(f, "no raster at all");
         return f;
       },
       "not recognized"},
      {"empty",
       [](const fs::path& f) {
         test::writeFile(f, "");
         return f;
       },
       "GDAL can read"},
      {"cut short",
       [](const fs::path& f) {
         test::RasterRecipe r;
         r.columns = r.rows = 200;
         test::writeRaster(f, r);
         fs::resize_file(f, 60000);
         return f;
       },
       "row "},
      {"no place",
       [&](const fs::path& f) {
         return test::writeRaster(f, recipe([](auto& r) { r.placed = false, r.crs = ""; }));
       },
       "georeference"},
      {"metres of nowhere",
       [&](const fs::path& f) {
         return test::writeRaster(f, recipe([](auto& r) { r.crs = "", r.west = 400000; }));
       },
       "coordinate reference system"},
      {"picture",
       [&](const fs::path& f) {
         return test::writeRaster(f, recipe([](auto& r) { r.bands = 3, r.type = GDT_Byte; }));
       },
       "image"},
      {"beyond the pole",
       [&](const fs::path& f) { return test::writeRaster(f, recipe([](auto& r) { r.north = 91; })); },
       "latitude"},
      {"one row",
       [&](const fs::path& f) { return test::writeRaster(f, recipe([](auto& r) { r.rows = 1; })); }, "size"},
      {"empty folder",
       [](const fs::path& f) {
         fs::create_directory(f);
         return f;
       },
       "none of 0 files"},
  };
  int count = 0;
  for (const Bad& b : bad) {
    const fs::path file = b.make(dir_ / ("bad" + std::to_string(count++) + ".tif"));
    const auto imported = importOne(file);
    ASSERT_FALSE(imported) << b.what;
    const std::string text = toString(imported.findings());
    EXPECT_NE(text.find(file.string()), std::string::npos) << text;
    EXPECT_NE(text.find(b.says), std::string::npos) << b.what << ": " << text;
  }
}

TEST_F(ImportMadeData, listsAllBadFilesNotTheFirst) {
  test::writeFile(dir_ / "a.tif", "x");
  test::writeFile(dir_ / "b.tif", "y");
  const std::vector<fs::path> sources{dir_ / "a.tif", dir_ / "b.tif"};
  const auto imported = test::importElevation(sources);
  ASSERT_FALSE(imported);
  EXPECT_TRUE(speaksOf(imported.findings(), "a.tif"));
  EXPECT_TRUE(speaksOf(imported.findings(), "b.tif"));
}

}  // namespace
}  // namespace trimtab::terrain
