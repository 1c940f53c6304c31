#include <gmock/gmock.h>

#include <cpl_string.h>

#include "rasters.h"
#include "read_elevation.h"
#include "trimtab/terrain/bake/cache.h"
#include "trimtab/terrain/elevation/files.h"
#include "trimtab/terrain/elevation/gdal_errors.h"

/// Files with several rasters.
namespace trimtab::terrain {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

struct Variable {
  const char *name, *unit;
  double base;
};

class Containers : public ::testing::Test {
 protected:
  /// A netCDF of several variables over 30 x 20 posts; empty where GDAL writes none. GDAL puts the number of
  /// the band behind each name.
  fs::path write(const std::string& name, const std::vector<Variable>& variables) {
    useGdal();
    GDALDriver* const netcdf = GetGDALDriverManager()->GetDriverByName("netCDF");
    if (netcdf == nullptr) return {};
    test::RasterRecipe recipe;
    recipe.columns = 30, recipe.rows = 20;
    recipe.bands = static_cast<int>(variables.size());
    recipe.value = [&](int c, int r, int band) {
      return variables[static_cast<std::size_t>(band - 1)].base + c + r;
    };
    GDALDataset* const made =
        GDALDataset::Open(test::writeRaster(dir_ / "made.tif", recipe).c_str(), GDAL_OF_UPDATE);
    for (int b = 1; b <= recipe.bands; ++b) {
      const Variable& variable = variables[static_cast<std::size_t>(b - 1)];
      made->GetRasterBand(b)->SetMetadataItem("NETCDF_VARNAME", variable.name);
      made->GetRasterBand(b)->SetMetadataItem("units", variable.unit);
    }
    const fs::path file = dir_ / name;
    fs::create_directories(file.parent_path());
    GDALDataset* const copy = netcdf->CreateCopy(file.c_str(), made, FALSE, nullptr, nullptr, nullptr);
    GDALClose(made);
    if (copy == nullptr) return {};
    GDALClose(copy);
    return file;
  }
  static float lowest(const fs::path& file) {
    const auto grid = test::readElevation(file);
    EXPECT_TRUE(grid) << toString(grid.findings());
    return grid ? *std::min_element(grid->heights.begin(), grid->heights.end()) : 0;
  }
  test::ScratchDir dir_;
};

TEST_F(Containers, giveTheOneRasterThatIsElevation) {
  const fs::path file = write("in/a.nc", {{"slope", "degree", 5}, {"elevation", "m", 640}, {"tid", "1", 20}});
  if (file.empty()) GTEST_SKIP() << "GDAL writes no netCDF";
  EXPECT_EQ(lowest(file), 640);
  const auto grid = test::readElevation(file);
  EXPECT_THAT(toString(grid.findings()), HasSubstr("of which elevation2 is taken for elevation"));
  const fs::path folder = dir_ / "in";
  EXPECT_EQ(lowest(folder), 640);
  const auto files = elevationFiles(std::span(&folder, 1));
  ASSERT_TRUE(files);
  EXPECT_EQ(*files, (std::vector<fs::path>{file.string() + ":elevation2"}));
}

TEST_F(Containers, ofWhichNoneStandsOutAskForAName) {
  const fs::path file = write("b.nc", {{"one", "m", 310}, {"two", "m", 420}});
  if (file.empty()) GTEST_SKIP() << "GDAL writes no netCDF";
  const auto asked = test::readElevation(file);
  ASSERT_FALSE(asked);
  EXPECT_THAT(toString(asked.findings()), AllOf(HasSubstr("FILE:NAME"), HasSubstr(file.string() + ":one1 ("),
                                                HasSubstr(file.string() + ":two2 (")));
  EXPECT_EQ(lowest(file.string() + ":two2"), 420);
  EXPECT_EQ(containerOf(file.string() + ":two2"), file);
  const auto wrong = test::readElevation(file.string() + ":three");
  ASSERT_FALSE(wrong);
  EXPECT_THAT(toString(wrong.findings()), AllOf(HasSubstr("no \"three\" in it"), HasSubstr(":one1 (")));
}

TEST_F(Containers, giveADatabaseOfTheRasterThatIsNamed) {
  const fs::path file = write("c.nc", {{"one", "m", 310}, {"two", "m", 420}});
  if (file.empty()) GTEST_SKIP() << "GDAL writes no netCDF";
  // Another raster of the same file is another database.
  for (const double base : {310.0, 420.0}) {
    const auto baked = openOrBake(file.string() + (base < 400 ? ":one1" : ":two2"), dir_ / "cache", {});
    ASSERT_TRUE(baked) << toString(baked.findings());
    EXPECT_EQ((*baked)->info().lowest.value(), base);
  }
}

}  // namespace
}  // namespace trimtab::terrain
