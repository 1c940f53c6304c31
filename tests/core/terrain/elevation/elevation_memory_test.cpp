#include <algorithm>
#include <cmath>
#include <limits>

#include "rasters.h"
#include "trimtab/terrain/elevation/source.h"
#include "trimtab/terrain/grid/voids.h"

namespace trimtab::terrain {
namespace {

/// Largest resident memory of this program since it was last asked, kB; 0 where the system does not tell.
std::size_t peakKb(bool restart) {
  if (restart) std::ofstream("/proc/self/clear_refs") << "5";
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.rfind("VmHWM:", 0) == 0) return std::stoul(line.substr(6));
  return 0;
}

/// 10,000 x 10,000 posts of which a few blocks are there.
std::filesystem::path writeSparse(const std::filesystem::path& file, const char* crs, double west,
                                  double north, double step) {
  GDALAllRegister();
  constexpr int kSide = 10000, kBlock = 256;
  const char* options[] = {"TILED=YES", "SPARSE_OK=TRUE", nullptr};
  GDALDataset* data = GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
      file.c_str(), kSide, kSide, 1, GDT_Float32, const_cast<char**>(options));
  std::array<double, 6> corner{west, step, 0, north, 0, -step};
  data->SetGeoTransform(corner.data());
  OGRSpatialReference reference;
  reference.SetFromUserInput(crs);
  data->SetSpatialRef(&reference);
  GDALRasterBand* band = data->GetRasterBand(1);
  band->SetNoDataValue(-9999);
  std::vector<float> block(kBlock * kBlock);
  for (int k = 0; k < 39; ++k) {
    std::fill(block.begin(), block.end(), 100.0f + static_cast<float>(k));
    if (band->WriteBlock((k * 7) % 39, k, block.data()) != CE_None) std::abort();
  }
  GDALClose(data);
  return file;
}

struct Large {
  const char *name, *crs;
  double west, north, step;
  bool filled;
};
class ElevationMemory : public ::testing::TestWithParam<Large> {};

TEST_P(ElevationMemory, doesNotFollowTheSizeOfTheData) {
  const Large& large = GetParam();
  test::ScratchDir dir;
  const auto file = writeSparse(dir / "large.tif", large.crs, large.west, large.north, large.step);
  const std::size_t before = peakKb(true);
  const std::vector<std::filesystem::path> files{file};
  const auto source = openElevation(files);
  ASSERT_TRUE(source) << toString(source.findings());
  const PostGrid& posts = (*source)->posts();
  ASSERT_GT(posts.size(), 90'000'000u);
  // Filled, its voids: wider than any band. What comes out goes nowhere.
  VoidFill fill;
  fill.columns = posts.columns, fill.rows = posts.rows;
  fill.scratch = dir.path();
  fill.memory = std::size_t{16} << 20;
  std::uint64_t voids = 0, rowsWritten = 0;
  fill.read = [&](std::uint32_t first, std::uint32_t rows, std::span<float> heights) {
    return (*source)->readRows(first, rows, heights);
  };
  float low = std::numeric_limits<float>::max(), high = 0;
  fill.write = [&](std::uint32_t, std::uint32_t rows, std::span<const float> heights) -> Result<Done> {
    rowsWritten += rows;
    for (const float h : heights) low = std::min(low, h), high = std::max(high, h);
    return Done{};
  };
  if (large.filled) {
    const auto filled = fillVoids(fill);
    ASSERT_TRUE(filled) << toString(filled.findings());
    voids = *filled;
    EXPECT_GT(rowsWritten, posts.rows - 300u);
    EXPECT_GE(low, 100);
    EXPECT_LE(high, 138);
  } else {
    std::vector<float> row(posts.columns);
    for (std::uint32_t r = 0; r < posts.rows; ++r) {
      ASSERT_TRUE(fill.read(r, 1, row));
      voids += static_cast<std::uint64_t>(
          std::count_if(row.begin(), row.end(), [](float h) { return std::isnan(h); }));
    }
  }
  EXPECT_GT(voids, 80'000'000u);
  EXPECT_LT(voids, posts.size() - 2'000'000u);
  // GDAL's cache of 128 MB, 16 MB of coarse levels, some hundred rows of 40 kB. The whole would be 400 MB.
  const std::size_t more = peakKb(false) - before;
  std::printf("%s: %zu x %zu posts, %zu kB of memory\n", large.name, std::size_t{posts.columns},
              std::size_t{posts.rows}, more);
  if (before > 0) {
    EXPECT_LT(more, 200000u);
  }
}
INSTANTIATE_TEST_SUITE_P(Sparse, ElevationMemory,
                         ::testing::Values(Large{"degrees", "EPSG:4326", 20, 40, 0.0002, false},
                                           Large{"metres", "EPSG:32652", 300000, 4300000, 30, true}),
                         [](const auto& instance) { return instance.param.name; });

TEST(ElevationMemoryOfManyFiles, isThatOfOne) {
  test::ScratchDir dir;
  test::RasterRecipe recipe;
  recipe.columns = 2048, recipe.rows = 1024, recipe.step = 0.0002, recipe.type = GDT_Byte;
  std::vector<std::filesystem::path> files;
  for (int k = 0; k < 40; ++k) {
    recipe.north = 50 - k * recipe.rows * recipe.step;
    files.push_back(test::writeRaster(dir / (std::to_string(k) + ".tif"), recipe));
  }
  const std::size_t before = peakKb(true);
  const auto source = openElevation(files);
  ASSERT_TRUE(source) << toString(source.findings());
  const PostGrid& posts = (*source)->posts();
  std::vector<float> row(posts.columns);
  for (std::uint32_t r = 0; r < posts.rows; r += 16) {
    ASSERT_TRUE((*source)->readRows(r, 1, row));
    ASSERT_EQ(row[r % posts.columns], 100);
  }
  // Of files that are open, what GDAL's cache keeps. A window of 8 MB for each would be 320 MB more.
  const std::size_t more = peakKb(false) - before;
  std::printf("40 files: %zu kB of memory\n", more);
  if (before > 0) {
    EXPECT_LT(more, 150000u);
  }
}

TEST(ElevationMemoryOfMeans, doesNotFollowTheDistanceOfPosts) {
  // However full the cache is by now.
  CPLSetConfigOption("GDAL_CACHEMAX", "16");
  const GIntBig cache = GDALGetCacheMax64();
  GDALSetCacheMax64(GIntBig{16} << 20);
  test::ScratchDir dir;
  const auto file = writeSparse(dir / "large.tif", "EPSG:4326", 20, 40, 0.0002);
  const std::size_t before = peakKb(true);
  ElevationOptions options;
  options.stepLatitude = 1;
  const auto source = openElevation(std::span(&file, 1), options);
  ASSERT_TRUE(source) << toString(source.findings());
  const PostGrid& posts = (*source)->posts();
  std::vector<float> heights(posts.size());
  ASSERT_TRUE((*source)->readRows(0, posts.rows, heights));
  // A post stands for 5,000 x 5,000: 100 MB, and 400 MB with as much again about them.
  const std::size_t more = peakKb(false) - before;
  std::printf("means: %zu kB of memory\n", more);
  if (before > 0) {
    EXPECT_LT(more, 80000u);
  }
  CPLSetConfigOption("GDAL_CACHEMAX", nullptr);
  GDALSetCacheMax64(cache);
}

}  // namespace
}  // namespace trimtab::terrain
