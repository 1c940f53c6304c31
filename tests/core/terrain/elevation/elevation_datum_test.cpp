#include <array>
#include <cmath>
#include <cstring>
#include <functional>

#include "elevation_fixture.h"

/// Vertical datums: heights come to the geoid where PROJ can take them there.
namespace trimtab::terrain {
namespace {

TEST_F(Elevation, takesVerticalDatumsToTheGeoidWherePROJCan) {
  auto ellipsoid = degrees(11.9, 47.6, 0.0005, 100, 100);
  ellipsoid.crs = "EPSG:4979";
  const auto source = open({ellipsoid});
  ASSERT_TRUE(source);
  EXPECT_NE(notes_.find("vertical datum"), std::string::npos) << notes_;
  const auto heights = test::readBands(*source, 32);
  const PostGrid& p = source->posts();
  // EGM96 stands 46 to 48 m above the ellipsoid there.
  for (std::size_t i = 0; i < heights.size(); i += 31) {
    const double lift = test::trueHeight(p.latitude(static_cast<double>(i / p.columns)),
                                         p.longitude(static_cast<double>(i % p.columns))) -
                        static_cast<double>(heights[i]);
    ASSERT_GT(lift, 45);
    ASSERT_LT(lift, 49);
  }
  ellipsoid.crs = "EPSG:4326+3855";  // EGM2008, whose grid is not there
  ASSERT_TRUE(open({ellipsoid}));
  EXPECT_NE(notes_.find("kept as they are"), std::string::npos) << notes_;
  ellipsoid.crs = "EPSG:4326+5773";
  ASSERT_TRUE(open({ellipsoid}));
  EXPECT_EQ(notes_.find("vertical datum"), std::string::npos) << notes_;
}

/// A geoid of one's own: heights at posts 0.05 degrees apart, from the south-west.
void writeGeoid(const fs::path& file, double west, double south, int columns, int rows,
                const std::function<float(double longitude)>& height) {
  std::string bytes;
  const auto put = [&](auto value) {
    std::array<char, sizeof value> raw;
    std::memcpy(raw.data(), &value, sizeof value);
    bytes.append(raw.rbegin(), raw.rend());
  };
  put(south), put(west), put(0.05), put(0.05), put(std::int32_t{rows}), put(std::int32_t{columns});
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) put(height(west + 0.05 * c));
  test::writeFile(file, bytes);
}
/// A raster with another vertical datum than its own.
fs::path aboveGeoid(const fs::path& raster, const fs::path& geoid, int columns, int rows,
                    const std::string& corner) {
  const fs::path file = fs::path(raster).replace_extension(".vrt");
  const std::string size = std::to_string(columns) + "\" rasterYSize=\"" + std::to_string(rows);
  test::writeFile(file, "<VRTDataset rasterXSize=\"" + size +
                            "\"><SRS>+proj=longlat +datum=WGS84 +geoidgrids=" + geoid.string() +
                            " +vunits=m +no_defs</SRS><GeoTransform>" + corner +
                            "</GeoTransform><VRTRasterBand dataType=\"Float32\" band=\"1\"><SimpleSource>"
                            "<SourceFilename>" +
                            raster.string() +
                            "</SourceFilename><SourceBand>1</SourceBand></SimpleSource></VRTRasterBand>"
                            "</VRTDataset>");
  return file;
}

TEST_F(Elevation, hasNoHeightsWherePROJHasNothingForTheirDatum) {
  const fs::path raster = test::write(dir_ / "a.tif", degrees(11.9, 47.6, 0.0005, 400, 400));
  const std::string corner = "11.9, 0.0005, 0, 47.6, 0, -0.0005";
  // Its east lies beyond the geoid.
  writeGeoid(dir_ / "half.gtx", 11.8, 47.3, 5, 10, [](double) { return 30.0f; });
  const fs::path half = aboveGeoid(raster, dir_ / "half.gtx", 400, 400, corner);
  const auto source = openElevation(std::span(&half, 1));
  ASSERT_TRUE(source) << toString(source.findings());
  EXPECT_NE(toString(source.findings()).find("PROJ has nothing for"), std::string::npos)
      << toString(source.findings());
  std::vector<std::uint8_t> beyond;
  const auto heights = test::readBands(**source, 32, &beyond);
  const PostGrid& posts = (*source)->posts();
  for (std::size_t i = 0; i < heights.size(); ++i) {
    const double longitude = posts.longitude(static_cast<double>(i % posts.columns));
    ASSERT_EQ(beyond[i], 0);
    ASSERT_EQ(std::isnan(heights[i]), longitude > 12) << longitude;
    if (longitude > 12) continue;
    // EGM96 stands 46 to 48 m above the ellipsoid, the other 30 m.
    const double lift = static_cast<double>(heights[i]) -
                        test::trueHeight(posts.latitude(static_cast<double>(i / posts.columns)), longitude);
    ASSERT_GT(lift, -18.5) << longitude;
    ASSERT_LT(lift, -15.5) << longitude;
  }
}

TEST_F(Elevation, isTakenToTheGeoidWhereTheMiddleIsOnItAlready) {
  OGRSpatialReference geoid, ellipsoid;
  geoid.SetFromUserInput("EPSG:4326+5773"), ellipsoid.SetFromUserInput("EPSG:4979");
  for (OGRSpatialReference* crs : {&geoid, &ellipsoid})
    crs->SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  const std::unique_ptr<OGRCoordinateTransformation> lift(
      OGRCreateCoordinateTransformation(&geoid, &ellipsoid));
  double x = 12, y = 47.5, egm96 = 0;
  ASSERT_TRUE(lift && lift->Transform(1, &x, &y, &egm96));
  // 20 m higher a tenth of a degree to the east.
  writeGeoid(dir_ / "tilted.gtx", 11.8, 47.3, 9, 10,
             [&](double longitude) { return static_cast<float>(egm96 + 200 * (longitude - 12)); });
  const fs::path raster = test::write(dir_ / "a.tif", degrees(11.9, 47.6, 0.0005, 400, 400)),
                 file =
                     aboveGeoid(raster, dir_ / "tilted.gtx", 400, 400, "11.9, 0.0005, 0, 47.6, 0, -0.0005");
  const auto source = openElevation(std::span(&file, 1));
  ASSERT_TRUE(source) << toString(source.findings());
  const auto heights = test::readBands(**source, 32);
  const PostGrid& posts = (*source)->posts();
  const std::size_t row = std::size_t{200} * posts.columns;
  for (const std::uint32_t column : {0u, 399u}) {
    const double longitude = posts.longitude(column);
    EXPECT_NEAR(static_cast<double>(heights[row + column]) - test::trueHeight(posts.latitude(200), longitude),
                200 * (longitude - 12), 1);
  }
}

}  // namespace
}  // namespace trimtab::terrain
