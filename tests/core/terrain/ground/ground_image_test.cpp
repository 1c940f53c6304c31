#include <cmath>

#include "ground_support.h"
#include "tests/core/terrain/elevation/read_elevation.h"
#include "tests/core/terrain/ground/build_and_open.h"
#include "trimtab/terrain/ground/image.h"

namespace trimtab::terrain {
namespace {

namespace fs = std::filesystem;
using test::GroundLand;
using test::Picture;

/// What GDAL reads at a place, between pixels, by its own transforms: an oracle for draped pictures.
class Placed {
 public:
  explicit Placed(const fs::path& file) {
    GDALAllRegister();
    data_ = static_cast<GDALDataset*>(GDALOpen(file.c_str(), GA_ReadOnly));
    std::array<double, 6> forward{};
    data_->GetGeoTransform(forward.data());
    EXPECT_TRUE(GDALInvGeoTransform(forward.data(), inverse_.data()));
    OGRSpatialReference from, to;
    from.importFromEPSG(4326);
    from.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    to = from;
    if (data_->GetSpatialRef() != nullptr) to = *data_->GetSpatialRef();
    to.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    transform_.reset(OGRCreateCoordinateTransformation(&from, &to));
  }
  ~Placed() { GDALClose(data_); }
  Placed(const Placed&) = delete;
  Placed& operator=(const Placed&) = delete;

  struct Range {
    double low = 1e9, high = -1e9;
    bool inside = false;
  };
  /// Lowest and highest of a band within so many pixels of a place.
  Range around(double longitude, double latitude, int band, double pixels) const {
    double x = longitude, y = latitude;
    if (!transform_->Transform(1, &x, &y)) return {};
    const double column = inverse_[0] + inverse_[1] * x + inverse_[2] * y,
                 row = inverse_[3] + inverse_[4] * x + inverse_[5] * y;
    const int c0 = static_cast<int>(std::floor(column - 0.5 - pixels)),
              c1 = static_cast<int>(std::floor(column + 0.5 + pixels)),
              r0 = static_cast<int>(std::floor(row - 0.5 - pixels)),
              r1 = static_cast<int>(std::floor(row + 0.5 + pixels));
    if (c0 < 0 || r0 < 0 || c1 >= data_->GetRasterXSize() || r1 >= data_->GetRasterYSize()) return {};
    std::vector<std::uint8_t> pixel(static_cast<std::size_t>((c1 - c0 + 1) * (r1 - r0 + 1)));
    EXPECT_EQ(data_->GetRasterBand(band)->RasterIO(GF_Read, c0, r0, c1 - c0 + 1, r1 - r0 + 1, pixel.data(),
                                                   c1 - c0 + 1, r1 - r0 + 1, GDT_Byte, 0, 0, nullptr),
              CE_None);
    const auto [low, high] = std::minmax_element(pixel.begin(), pixel.end());
    return {double(*low), double(*high), true};
  }
  int bands() const { return data_->GetRasterCount(); }

 private:
  GDALDataset* data_ = nullptr;
  std::array<double, 6> inverse_{};
  std::unique_ptr<OGRCoordinateTransformation> transform_;
};

/// Every texel lies between the pixels about its place: a picture that is off by more than `pixels` has
/// texels that do not. Returns how many were looked at.
int expectDraped(const GroundPyramid& pyramid, const PostGrid& posts, const fs::path& image, double pixels,
                 std::uint32_t every) {
  const Placed oracle(image);
  const Picture finest = test::readLevel(pyramid, 0);
  const double texels = pyramid.shape().texelsPerPost;
  int looked = 0, wrong = 0;
  for (std::uint32_t r = 0; r < finest.rows; r += every)
    for (std::uint32_t c = 0; c < finest.columns; c += every) {
      const GroundTexel& t = finest.at(c, r);
      const int found[3] = {t.red, t.green, t.blue};
      const auto alpha = oracle.bands() < 4 ? Placed::Range{255, 255, true}
                                            : oracle.around(posts.longitude(c / texels),
                                                            posts.latitude(r / texels), 4, pixels);
      if (alpha.low < 255) continue;
      for (int k = 0; k < 3; ++k) {
        const auto range = oracle.around(posts.longitude(c / texels), posts.latitude(r / texels),
                                         oracle.bands() >= 3 ? k + 1 : 1, pixels);
        if (!range.inside) continue;
        ++looked;
        if (found[k] < range.low - 1 || found[k] > range.high + 1) ++wrong;
      }
    }
  EXPECT_EQ(wrong, 0) << "of " << looked;
  return looked;
}

class GroundImages : public ::testing::Test {
 protected:
  static std::shared_ptr<const GroundPyramid> draped(const GroundSources& sources) {
    const auto pyramid = test::buildAndOpenGround(sources);
    EXPECT_TRUE(pyramid) << toString(pyramid.findings());
    return pyramid ? *pyramid : nullptr;
  }
  test::ScratchDir dir_;
};

double waves(int c, int r, int band) {
  return 128 + 60 * std::sin(c * 0.11 * band) + 60 * std::cos(r * 0.13 + band);
}

TEST_F(GroundImages, lieWhereGdalReadsThemInUtm) {
  GroundLand land(400, 360, 10.05, 49.9, 1.0 / 1200);
  test::RasterRecipe picture;
  picture.bands = 3;
  picture.type = GDT_Byte;
  picture.crs = "EPSG:32632";
  picture.west = 565000, picture.north = 5575000, picture.step = 40;
  picture.columns = 900, picture.rows = 1250;
  picture.value = waves;
  GroundSources sources = land.sources();
  sources.images = {test::writeRaster(dir_ / "utm.tif", picture)};
  const auto pyramid = draped(sources);
  ASSERT_TRUE(pyramid);
  EXPECT_EQ(pyramid->shape().texelsPerPost, 2);
  // A fifth of a pixel: the warp's own error is a tenth.
  EXPECT_GT(expectDraped(*pyramid, land.grid.posts, sources.images[0], 0.2, 3), 100000);
}

TEST_F(GroundImages, lieWhereGdalReadsThemInDegrees) {
  GroundLand land(400, 360, 10.0213, 49.9171, 1.0 / 1200);
  test::RasterRecipe picture;
  picture.bands = 3;
  picture.type = GDT_Byte;
  picture.west = 10.1, picture.north = 50.2, picture.step = 1.0 / 3000;
  picture.columns = 900, picture.rows = 900;
  picture.value = waves;
  GroundSources sources = land.sources();
  sources.images = {test::writeRaster(dir_ / "degrees.tif", picture)};
  const auto pyramid = draped(sources);
  ASSERT_TRUE(pyramid);
  EXPECT_EQ(pyramid->shape().texelsPerPost, 2);
  EXPECT_GT(expectDraped(*pyramid, land.grid.posts, sources.images[0], 0.2, 3), 50000);
  sources.mostTexelsPerPost = 1;
  EXPECT_EQ(draped(sources)->shape().texelsPerPost, 1);
  sources.texelsPerPost = 4;
  EXPECT_EQ(draped(sources)->shape().texelsPerPost, 4);
}

TEST_F(GroundImages, onTheGridOfThePostsKeepEveryPixel) {
  GroundLand land(300, 300, 10, 50, 0.001);
  test::RasterRecipe picture;
  picture.bands = 3;
  picture.type = GDT_Byte;
  picture.columns = picture.rows = 300;
  picture.west = 10 - 0.0005, picture.north = 50 + 0.2995, picture.step = 0.001;
  picture.value = [](int c, int r, int band) { return (c * 37 + r * 91 * band) % 256; };
  GroundSources sources = land.sources();
  sources.images = {test::writeRaster(dir_ / "same.tif", picture)};
  const auto pyramid = draped(sources);
  ASSERT_TRUE(pyramid);
  EXPECT_EQ(pyramid->shape().texelsPerPost, 1);
  const Picture finest = test::readLevel(*pyramid, 0);
  for (int r = 0; r < 300; ++r)
    for (int c = 0; c < 300; ++c) {
      const GroundTexel& t = finest.at(static_cast<std::uint32_t>(c), static_cast<std::uint32_t>(299 - r));
      ASSERT_EQ(t.red, (c * 37 + r * 91) % 256);
      ASSERT_EQ(t.green, (c * 37 + r * 182) % 256);
    }
}

TEST_F(GroundImages, leaveGroundWithoutThemToTheLand) {
  GroundLand land(300, 300, 10, 50, 0.001);
  GroundSources sources = land.sources();
  const Picture bare = test::readLevel(*draped(sources), 0);
  test::RasterRecipe picture;
  picture.type = GDT_Byte;
  picture.columns = picture.rows = 300;
  picture.west = 10 - 0.0005, picture.north = 50 + 0.2995, picture.step = 0.001;
  const auto expectHalf = [&](const fs::path& file, int red) {
    sources.images = {file};
    const auto pyramid = draped(sources);
    ASSERT_TRUE(pyramid) << file;
    const Picture finest = test::readLevel(*pyramid, 0);
    for (std::uint32_t r = 0; r < 300; ++r)
      for (std::uint32_t c = 0; c < 300; ++c) {
        if (c < 100) {
          ASSERT_EQ(finest.at(c, r).red, red) << file << c << ", " << r;
        }
        if (c >= 101) {
          ASSERT_TRUE(finest.at(c, r) == bare.at(c, r)) << file << c << ", " << r;
        }
      }
  };
  picture.bands = 4;
  picture.value = [](int c, int, int band) { return band == 4 ? (c < 100 ? 255 : 0) : 250; };
  expectHalf(test::writeRaster(dir_ / "alpha.tif", picture), 250);
  picture.bands = 3;
  picture.noData = 7;
  picture.value = [](int c, int, int) { return c < 100 ? 240 : 7; };
  expectHalf(test::writeRaster(dir_ / "nodata.tif", picture), 240);
  picture.bands = 1;
  picture.value = [](int c, int, int) { return c < 100 ? 90 : 7; };
  expectHalf(test::writeRaster(dir_ / "grey.tif", picture), 90);
  picture.columns = 100;  // ends there
  picture.noData = {};
  expectHalf(test::writeRaster(dir_ / "ends.tif", picture), 90);
}

TEST_F(GroundImages, ofAPaletteHaveItsColours) {
  GroundLand land(300, 300, 10, 50, 0.001);
  test::RasterRecipe picture;
  picture.type = GDT_Byte;
  picture.columns = picture.rows = 300;
  picture.west = 10 - 0.0005, picture.north = 50 + 0.2995, picture.step = 0.001;
  picture.value = [](int c, int, int) { return c < 150 ? 3 : 9; };
  const fs::path file = test::writeRaster(dir_ / "palette.tif", picture);
  {
    auto* data = static_cast<GDALDataset*>(GDALOpen(file.c_str(), GA_Update));
    GDALColorTable colours;
    const GDALColorEntry first{200, 30, 40, 255}, second{10, 220, 90, 255};
    colours.SetColorEntry(3, &first);
    colours.SetColorEntry(9, &second);
    ASSERT_EQ(data->GetRasterBand(1)->SetColorTable(&colours), CE_None);
    GDALClose(data);
  }
  GroundSources sources = land.sources();
  sources.images = {file};
  const auto pyramid = draped(sources);
  ASSERT_TRUE(pyramid);
  const Picture finest = test::readLevel(*pyramid, 0);
  EXPECT_EQ(finest.at(10, 10).red, 200);
  EXPECT_EQ(finest.at(10, 10).blue, 40);
  EXPECT_EQ(finest.at(290, 10).green, 220);
}

TEST_F(GroundImages, theFirstThatHasSomethingGivesTheColour) {
  GroundLand land(300, 300, 10, 50, 0.001);
  test::RasterRecipe picture;
  picture.bands = 3;
  picture.type = GDT_Byte;
  picture.columns = 150, picture.rows = 300;
  picture.west = 10 - 0.0005, picture.north = 50 + 0.2995, picture.step = 0.001;
  picture.value = [](int, int, int) { return 11; };
  GroundSources sources = land.sources();
  sources.images.push_back(test::writeRaster(dir_ / "near.tif", picture));
  picture.columns = 300;
  picture.value = [](int, int, int) { return 222; };
  sources.images.push_back(test::writeRaster(dir_ / "far.tif", picture));
  const Picture finest = test::readLevel(*draped(sources), 0);
  EXPECT_EQ(finest.at(100, 100).red, 11);
  EXPECT_EQ(finest.at(200, 100).red, 222);
}

TEST_F(GroundImages, goOnAcrossTheDateLine) {
  test::RasterRecipe world;
  world.bands = 3;
  world.type = GDT_Byte;
  world.columns = 7200, world.rows = 400;
  world.west = -180, world.north = 0, world.step = 0.05;
  world.value = [](int c, int r, int band) { return band == 1 ? c % 7200 * 255 / 7200 : r % 256; };
  GroundLand land(600, 200, 179.7, -17, 0.001);
  GroundSources sources = land.sources();
  sources.images = {test::writeRaster(dir_ / "world.tif", world)};
  const auto pyramid = draped(sources);
  ASSERT_TRUE(pyramid);
  const Picture finest = test::readLevel(*pyramid, 0);
  for (std::uint32_t c = 0; c < 600; ++c) {
    const double longitude = land.grid.posts.longitude(c);
    const int expected = longitude < 180 ? 254 : 0;
    ASSERT_NEAR(finest.at(c, 100).red, expected, 1) << longitude;
    ASSERT_NEAR(finest.at(c, 100).green, static_cast<int>(16.9 / 0.05 - 0.5) % 256, 1.5);
  }
}

TEST_F(GroundImages, withoutAPlaceOnEarthAreRefused) {
  GroundLand land(300, 300, 10, 50, 0.001);
  const auto refusal = [&](const fs::path& file) {
    GroundSources sources = land.sources();
    sources.images = {file};
    const auto pyramid = test::buildAndOpenGround(sources);
    EXPECT_FALSE(pyramid) << file;
    return toString(pyramid.findings());
  };
  test::RasterRecipe picture;
  picture.bands = 3;
  picture.type = GDT_Byte;
  picture.crs = "";
  picture.west = 570000, picture.north = 5541000, picture.step = 50;
  const std::string noCrs = refusal(test::writeRaster(dir_ / "nocrs.tif", picture));
  EXPECT_NE(noCrs.find("coordinate reference system"), std::string::npos) << noCrs;
  EXPECT_NE(noCrs.find("nocrs.tif"), std::string::npos);
  picture.placed = false;
  const std::string nowhere = refusal(test::writeRaster(dir_ / "nowhere.tif", picture));
  EXPECT_NE(nowhere.find("georeference"), std::string::npos) << nowhere;
  picture.placed = true;
  picture.crs = "EPSG:32632";
  picture.west = 800000;
  const std::string far = refusal(test::writeRaster(dir_ / "far.tif", picture));
  EXPECT_NE(far.find("over the terrain"), std::string::npos) << far;
  const std::string heights = refusal(test::writeRaster(dir_ / "heights.tif", {}));
  EXPECT_NE(heights.find("Float32"), std::string::npos) << heights;
  picture.bands = 4;
  picture.west = 571000;
  picture.value = [](int, int, int band) { return band == 4 ? 0 : 90; };
  const std::string clear = refusal(test::writeRaster(dir_ / "clear.tif", picture));
  EXPECT_NE(clear.find("over the terrain"), std::string::npos) << clear;
}

/// Elevation of a file as land to drape on.
std::unique_ptr<GroundLand> landOf(const fs::path& file) {
  const std::vector<fs::path> sources{file};
  auto imported = test::importElevation(sources);
  EXPECT_TRUE(imported) << toString(imported.findings());
  if (!imported) return nullptr;
  auto land = std::make_unique<GroundLand>((*imported).grid.posts);
  land->grid = std::move((*imported).grid);
  return land;
}

TEST_F(GroundImages, ofCraterLakeAreItsPixels) {
  TRIMTAB_NEEDS_SHARED("data/dem-image-craterlake");
  const fs::path folder = test::sharedDir() / "data/dem-image-craterlake";
  const auto land = landOf(folder / "craterlake-elev-16bit-30m.tif");
  ASSERT_TRUE(land);
  GroundSources sources = land->sources();
  sources.images = {folder / "craterlake-imagery-30m.tif"};
  const auto pyramid = draped(sources);
  ASSERT_TRUE(pyramid);
  EXPECT_EQ(pyramid->shape().texelsPerPost, 1);
  EXPECT_GT(expectDraped(*pyramid, land->grid.posts, sources.images[0], 0.2, 1), 150000);
}

TEST_F(GroundImages, ofTheCoastOfSantaBarbaraLieOnIt) {
  TRIMTAB_NEEDS_SHARED("data/dem-image-sba");
  const fs::path folder = test::sharedDir() / "data/dem-image-sba";
  const auto land = landOf(folder / "sba_elev32_wgs84_512x512.tif");
  ASSERT_TRUE(land);
  GroundSources sources = land->sources();
  sources.images = {folder / "sba_rgb_wgs84_512x512.tif"};
  const auto pyramid = draped(sources);
  ASSERT_TRUE(pyramid);
  EXPECT_GT(expectDraped(*pyramid, land->grid.posts, sources.images[0], 0.2, 1), 500000);
}

TEST_F(GroundImages, ofTheWholeEarthNeedAPlaceAndThenLieOnIt) {
  TRIMTAB_NEEDS_SHARED("data/imagery-global/earth-blue-marble.jpg");
  GroundLand land(500, 500, 85, 25, 0.02);
  GroundSources sources = land.sources();
  sources.images = {test::sharedDir() / "data/imagery-global/earth-blue-marble.jpg"};
  const auto refused = test::buildAndOpenGround(sources);
  ASSERT_FALSE(refused);
  EXPECT_NE(toString(refused.findings()).find("georeference"), std::string::npos);
  fs::copy_file(sources.images[0], dir_ / "earth.jpg");
  test::writeFile(dir_ / "earth.jgw", "0.087890625\n0\n0\n-0.087890625\n-179.9560546875\n89.9560546875\n");
  sources.images = {dir_ / "earth.jpg"};
  const auto pyramid = draped(sources);
  ASSERT_TRUE(pyramid);
  EXPECT_GT(expectDraped(*pyramid, land.grid.posts, sources.images[0], 0.2, 2), 100000);
}

}  // namespace
}  // namespace trimtab::terrain
