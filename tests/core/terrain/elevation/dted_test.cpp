#include <gdal_priv.h>

#include "rasters.h"
#include "read_elevation.h"

/// DTED as a series of profiles: each with a checksum, none missing.
namespace trimtab::terrain {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kHeaders = 3428, kColumns = 121, kRows = 121, kProfile = 12 + 2 * kRows;

class Dted : public ::testing::Test {
 protected:
  Dted() {
    test::RasterRecipe recipe;
    recipe.columns = kColumns, recipe.rows = kRows;
    recipe.step = 1.0 / 120;
    recipe.west = 10 - recipe.step / 2, recipe.north = 46 + recipe.step / 2;
    recipe.type = GDT_Int16;
    recipe.value = [](int c, int r, int) { return 300 + 7 * c + 3 * r; };
    GDALDataset* from = GDALDataset::Open(test::writeRaster(dir_ / "from.tif", recipe).c_str());
    GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("DTED");
    GDALClose(driver->CreateCopy(file_.c_str(), from, FALSE, nullptr, nullptr, nullptr));
    GDALClose(from);
    bytes_ = test::readFile(file_);
  }
  Result<HeightGrid> read(const std::string& bytes, bool ignoreChecksums = false) const {
    test::writeFile(file_, bytes);
    ElevationOptions options;
    options.reading.ignoreChecksums = ignoreChecksums;
    auto source = openElevation(std::span(&file_, 1), options);
    if (!source) return source.findings();
    auto grid = test::allRows(**source);
    if (!grid) return grid.findings();
    return Result<HeightGrid>(std::move(grid).value(), source.findings());
  }
  static void expectSays(const Findings& findings, std::initializer_list<const char*> words) {
    const std::string text = toString(findings);
    for (const char* word : words) EXPECT_NE(text.find(word), std::string::npos) << word << ": " << text;
  }
  test::ScratchDir dir_;
  fs::path file_ = dir_ / "n45_e010.dt0";
  std::string bytes_;
};

TEST_F(Dted, thatIsWholeHasNoFinding) {
  ASSERT_EQ(bytes_.size(), kHeaders + kColumns * kProfile);
  const auto grid = read(bytes_);
  ASSERT_TRUE(grid) << toString(grid.findings());
  EXPECT_TRUE(grid.findings().empty()) << toString(grid.findings());
}

TEST_F(Dted, withAWrongSumIsRefusedUnlessTheUserSaysSo) {
  std::string bytes = bytes_;
  bytes[kHeaders + 33 * kProfile + 60] ^= 1;
  const auto refused = read(bytes);
  ASSERT_FALSE(refused);
  expectSays(refused.findings(),
             {"n45_e010.dt0", "--ignore-checksums", "1 of 121", "column 33 (longitude 10.275)"});
  const auto taken = read(bytes, true);
  ASSERT_TRUE(taken) << toString(taken.findings());
  expectSays(taken.findings(), {"--ignore-checksums", "column 33"});
}

TEST_F(Dted, whoseSumsAreAllZeroIsNamedAsThat) {
  std::string bytes = bytes_;
  for (std::size_t column = 0; column < kColumns; ++column)
    bytes.replace(kHeaders + (column + 1) * kProfile - 4, 4, 4, '\0');
  const auto refused = read(bytes);
  ASSERT_FALSE(refused);
  expectSays(refused.findings(), {"all are 0", "--ignore-checksums"});
  const auto taken = read(bytes, true);
  ASSERT_TRUE(taken) << toString(taken.findings());
  EXPECT_EQ(taken->heights[5], 300 + 7 * 5 + 3 * 120);
}

TEST_F(Dted, thatIsCutAtTheEndOfAProfileNamesTheFirstThatIsMissing) {
  for (const bool ignoring : {false, true}) {
    const auto refused = read(bytes_.substr(0, kHeaders + 84 * kProfile), ignoring);
    ASSERT_FALSE(refused);
    expectSays(refused.findings(), {"column 84 (longitude 10.7)", "84", "cut"});
  }
}

TEST_F(Dted, thatLeavesAProfileOutHasVoidsThere) {
  std::string bytes = bytes_;
  bytes.erase(kHeaders + 50 * kProfile, kProfile);
  const auto grid = read(bytes);
  ASSERT_TRUE(grid) << toString(grid.findings());
  expectSays(grid.findings(), {"column 50", "voids"});
  EXPECT_EQ(grid.findings().front().severity, Severity::warning);
  EXPECT_TRUE(std::isnan(grid->heights[50]));
  EXPECT_EQ(grid->heights[51], 300 + 7 * 51 + 3 * 120);
}

}  // namespace
}  // namespace trimtab::terrain
