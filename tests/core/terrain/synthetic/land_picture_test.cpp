#include "trimtab/terrain/synthetic/land_picture.h"

#include <set>

#include "tests/core/terrain/elevation/rasters.h"
#include "tests/core/terrain/elevation/read_elevation.h"
#include "trimtab/terrain/ground/imagery.h"
#include "trimtab/terrain/synthetic/sample.h"

namespace trimtab::terrain {
namespace {

using ::testing::HasSubstr;

/// What a picture shows of posts, and how they lie.
struct Seen {
  HeightGrid land;
  std::vector<std::uint8_t> rgba;

  bool isBlue(std::size_t post) const { return rgba[4 * post + 2] > rgba[4 * post] + 15; }
};

class LandPicture : public ::testing::Test {
 protected:
  void SetUp() override {
    SampleOptions options;
    options.postM = 240;
    const auto made = writeSample(land_, options);
    ASSERT_TRUE(made) << toString(made.findings());
  }
  Seen paint(const LandPictureOptions& options) {
    const auto done = writeLandPicture(land_, picture_, options);
    EXPECT_TRUE(done) << toString(done.findings());
    auto land = test::readElevation(land_);
    EXPECT_TRUE(land) << toString(land.findings());
    auto seen = readImagery(std::span(&picture_, 1), land->posts, nullptr);
    EXPECT_TRUE(seen) << toString(seen.findings());
    return {std::move(land).value(), std::move(seen).value()};
  }
  test::ScratchDir dir_;
  std::filesystem::path land_ = dir_ / "land.tif", picture_ = dir_ / "picture.tif";
};

TEST_F(LandPicture, showsTheSeaWhereItIsAndLandThatIsNotOneColour) {
  LandPictureOptions options;
  options.pixelM = 80;
  const Seen seen = paint(options);
  std::size_t wrong = 0, counted = 0;
  std::set<int> greens;
  const std::uint32_t columns = seen.land.posts.columns;
  for (std::uint32_t r = 2; r + 2 < seen.land.posts.rows; ++r)
    for (std::uint32_t c = 2; c + 2 < columns; ++c) {
      // The shore itself lies between posts.
      const std::size_t post = std::size_t{r} * columns + c;
      const auto around = [&](auto test) {
        for (const std::size_t near : {post, post - 1, post + 1, post - columns, post + columns})
          if (!test(seen.land.heights[near])) return false;
        return true;
      };
      const bool sea = around([](float h) { return h <= 0; }), hill = around([](float h) { return h > 400; });
      if (!sea && !hill) continue;
      ++counted;
      wrong += seen.isBlue(post) != sea;
      if (hill) greens.insert(seen.rgba[4 * post + 1]);
    }
  EXPECT_GT(counted, 30'000u);
  EXPECT_LT(wrong * 50, counted) << "rivers among hills are few";
  EXPECT_GT(greens.size(), 60u);
}

TEST_F(LandPicture, hasRiversWhereALotDrains) {
  LandPictureOptions options;
  options.pixelM = 80;
  const Seen seen = paint(options);
  std::size_t rivers = 0;
  for (std::size_t post = 0; post < seen.land.heights.size(); ++post)
    rivers += seen.land.heights[post] > 20 && seen.isBlue(post);
  EXPECT_GT(rivers, 300u);
}

TEST_F(LandPicture, isTheSameForASeedAndAnotherForAnother) {
  LandPictureOptions options;
  options.pixelM = 240;
  const Seen first = paint(options), again = paint(options);
  EXPECT_EQ(first.rgba, again.rgba);
  options.seed = 2;
  EXPECT_NE(paint(options).rgba, first.rgba);
}

TEST_F(LandPicture, hasPixelsOfTheSizeThatIsAskedFor) {
  for (const auto& [pixelM, finer] :
       {std::pair{80.0, 3}, std::pair{240.0, 1}, std::pair{100.0, 2}, std::pair{2000.0, 1}}) {
    LandPictureOptions options;
    options.pixelM = pixelM;
    const Seen seen = paint(options);
    GDALDataset* data = GDALDataset::FromHandle(GDALOpen(picture_.c_str(), GA_ReadOnly));
    ASSERT_NE(data, nullptr);
    EXPECT_EQ(data->GetRasterXSize(), static_cast<int>(seen.land.posts.columns - 1) * finer) << pixelM;
    EXPECT_EQ(data->GetRasterYSize(), static_cast<int>(seen.land.posts.rows - 1) * finer) << pixelM;
    GDALClose(data);
  }
}

TEST_F(LandPicture, refusesWhatItCannotPaint) {
  const auto refusal = [&](const std::filesystem::path& land, double pixelM) {
    LandPictureOptions options;
    options.pixelM = pixelM;
    const auto done = writeLandPicture(land, picture_, options);
    EXPECT_FALSE(done);
    EXPECT_FALSE(std::filesystem::exists(picture_));
    return toString(done.findings());
  };
  EXPECT_THAT(refusal(dir_ / "none.tif", 10), HasSubstr("none.tif"));
  EXPECT_THAT(refusal(land_, 0), HasSubstr("pixel"));
  test::RasterRecipe projected;
  projected.crs = "EPSG:32652";
  projected.step = 30;
  projected.west = 500000;
  projected.north = 4000000;
  EXPECT_THAT(refusal(test::writeRaster(dir_ / "utm.tif", projected), 10), HasSubstr("WGS84"));
}

TEST_F(LandPicture, leavesNothingBehindWhenItIsCancelled) {
  LandPictureOptions options;
  options.pixelM = 80;
  int told = 0;
  options.progress = [&](double, const std::string&) { return ++told < 3; };
  const auto done = writeLandPicture(land_, picture_, options);
  ASSERT_FALSE(done);
  EXPECT_THAT(toString(done.findings()), HasSubstr("cancelled"));
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& file : std::filesystem::directory_iterator(land_.parent_path())) ++files;
  EXPECT_EQ(files, 1u);
}

TEST_F(LandPicture, takesVoidsForSea) {
  test::RasterRecipe recipe;
  recipe.noData = -32768;
  recipe.value = [](int column, int, int) { return column < 32 ? -32768.0 : 500.0; };
  land_ = test::writeRaster(dir_ / "void.tif", recipe);
  LandPictureOptions options;
  options.pixelM = 111;
  ASSERT_TRUE(writeLandPicture(land_, picture_, options));
  PostGrid posts;
  posts.west = 10.01, posts.south = 49.97, posts.stepLongitude = 0.04, posts.stepLatitude = 0.01;
  posts.columns = 2, posts.rows = 2;
  const auto rgba = readImagery(std::span(&picture_, 1), posts, nullptr);
  ASSERT_TRUE(rgba);
  EXPECT_GT((*rgba)[2], (*rgba)[0]) << "west: sea";
  EXPECT_GT((*rgba)[5], (*rgba)[6]) << "east: land";
}

}  // namespace
}  // namespace trimtab::terrain
