#pragma once

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "elevation_truth.h"
#include "trimtab/terrain/elevation/source.h"

/// What tests of elevation sources share: rasters of the true ground, opened together.
namespace trimtab::terrain {

namespace fs = std::filesystem;
using test::TrueRaster;

/// About 12 E, 47.5 N, where UTM zones 32 and 33 meet: 11.9 to 12.1 E, 47.4 to 47.6 N.
inline TrueRaster degrees(double west, double north, double step, int columns, int rows) {
  return {"EPSG:4326", test::geographic, west, north, step, columns, rows};
}
inline TrueRaster inUtm(int zone, double latitude, double longitude, double step, int columns, int rows,
                        bool northern = true) {
  int found;
  bool isNorth;
  double x, y;
  GeographicLib::UTMUPS::Forward(latitude, longitude, found, isNorth, x, y, zone);
  if (isNorth != northern) y += northern ? -1e7 : 1e7;
  const std::string code = std::to_string(zone);
  return {"EPSG:32" + std::string(northern ? "6" : "7") + (zone < 10 ? "0" : "") + code,
          test::utm(zone, northern),
          std::floor(x),
          std::floor(y),
          step,
          columns,
          rows};
}
class Elevation : public ::testing::Test {
 protected:
  std::unique_ptr<ElevationSource> open(const std::vector<TrueRaster>& rasters,
                                        ElevationOptions options = {}) {
    std::vector<fs::path> files;
    for (const TrueRaster& raster : rasters)
      files.push_back(test::write(dir_ / (std::to_string(count_++) + ".tif"), raster));
    auto source = openElevation(files, options);
    EXPECT_TRUE(source) << toString(source.findings());
    if (!source) return nullptr;
    notes_ = toString(source.findings());
    return std::move(source).value();
  }
  /// Largest difference from the truth, and how many posts have a height.
  static std::pair<double, std::size_t> error(const PostGrid& posts, const std::vector<float>& heights) {
    double worst = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < heights.size(); ++i) {
      if (std::isnan(heights[i])) continue;
      ++count;
      const double truth = test::trueHeight(posts.latitude(static_cast<double>(i / posts.columns)),
                                            posts.longitude(static_cast<double>(i % posts.columns)));
      worst = std::max(worst, std::abs(static_cast<double>(heights[i]) - truth));
    }
    return {worst, count};
  }
  test::ScratchDir dir_;
  int count_ = 0;
  std::string notes_;
};

}  // namespace trimtab::terrain
