#pragma once

#include <GeographicLib/Geocentric.hpp>
#include <GeographicLib/LambertConformalConic.hpp>
#include <GeographicLib/UTMUPS.hpp>

#include <cmath>
#include <numbers>

#include "rasters.h"
#include "trimtab/terrain/elevation/source.h"

/// Ground that is known everywhere on earth, and rasters of it in many reference systems, placed without
/// PROJ.
namespace trimtab::test {

/// Waves in space, 2 to 5 km long, so that there is no edge at a pole or the date line.
inline double trueHeight(double latitude, double longitude) {
  constexpr double kDegree = std::numbers::pi / 180, kEarth = 6371000;
  const double x = kEarth * std::cos(latitude * kDegree) * std::cos(longitude * kDegree),
               y = kEarth * std::cos(latitude * kDegree) * std::sin(longitude * kDegree),
               z = kEarth * std::sin(latitude * kDegree);
  return 900 + 250 * std::sin(x / 700) + 250 * std::sin(y / 500) * std::cos(z / 600) +
         100 * std::sin(z / 400 + x / 900);
}
/// The largest sum of its curvatures along two axes that are square to each other, 1/m.
inline constexpr double kCurvature = 250 / (700.0 * 700) + 250 / (500.0 * 500) + 250 / (600.0 * 600) +
                                     100 / (400.0 * 400) + 100 / (900.0 * 900);
inline constexpr double kSlope = 250 / 700.0 + 250 / 500.0 + 250 / 600.0 + 100 / 400.0 + 100 / 900.0;
/// What a bilinear surface through posts so far apart may differ from it.
inline double bilinearLimit(double postsM) {
  return postsM * postsM / 8 * kCurvature;
}

struct Degrees2 {
  double latitude, longitude;
};
using ToDegrees = std::function<Degrees2(double x, double y)>;

inline Degrees2 geographic(double x, double y) {
  return {y, x};
}
inline ToDegrees utm(int zone, bool north = true) {
  return [=](double x, double y) {
    Degrees2 d{};
    GeographicLib::UTMUPS::Reverse(zone, north, x, y, d.latitude, d.longitude, false);
    return d;
  };
}
/// ETRS89 / LCC Europe.
inline Degrees2 lambertEurope(double x, double y) {
  static const GeographicLib::LambertConformalConic cone(6378137, 1 / 298.257222101, 35, 65, 1);
  double x0, y0;
  cone.Forward(10, 52, 10, x0, y0);
  Degrees2 d{};
  cone.Reverse(10, x - 4000000 + x0, y - 2800000 + y0, d.latitude, d.longitude);
  return d;
}
/// ED50 in degrees, by its mean shift.
inline const char* const kEd50 = "+proj=longlat +ellps=intl +towgs84=-87,-98,-121 +no_defs";
inline Degrees2 ed50(double x, double y) {
  static const GeographicLib::Geocentric hayford(6378388, 1 / 297.0);
  double u, v, w, height;
  hayford.Forward(y, x, 0, u, v, w);
  Degrees2 d{};
  GeographicLib::Geocentric::WGS84().Reverse(u - 87, v - 98, w - 121, d.latitude, d.longitude, height);
  return d;
}

/// A raster of the true heights, plus `lift`, about a place.
struct TrueRaster {
  std::string crs = "EPSG:4326";
  ToDegrees toDegrees = geographic;
  double west = 0, north = 0, step = 0;
  int columns = 0, rows = 0;
  double lift = 0;
  double unit = 1;  ///< metres; 0.3048 is named in the file
  bool southUp = false;
  std::function<bool(double latitude, double longitude)> isVoid = {};
  std::optional<double> stepEast = {};  ///< where that differs
};
inline std::filesystem::path write(const std::filesystem::path& file, const TrueRaster& raster) {
  RasterRecipe recipe;
  recipe.crs = raster.crs;
  recipe.west = raster.west, recipe.north = raster.north, recipe.step = raster.step;
  recipe.stepEast = raster.stepEast;
  recipe.columns = raster.columns, recipe.rows = raster.rows;
  recipe.southUp = raster.southUp;
  recipe.noData = -12345;
  if (raster.unit != 1) recipe.unit = "ft";
  recipe.value = [&](int c, int r, int) {
    const Degrees2 d = raster.toDegrees(raster.west + (c + 0.5) * raster.stepEast.value_or(raster.step),
                                        raster.north - (r + 0.5) * raster.step);
    if (raster.isVoid && raster.isVoid(d.latitude, d.longitude)) return -12345.0;
    return (trueHeight(d.latitude, d.longitude) + raster.lift) / raster.unit;
  };
  return writeRaster(file, recipe);
}

/// All of a source, by bands of so many rows.
inline std::vector<float> readBands(terrain::ElevationSource& source, std::uint32_t band,
                                    std::vector<std::uint8_t>* beyond = nullptr) {
  const auto& posts = source.posts();
  std::vector<float> heights(posts.size());
  std::vector<std::uint8_t> none(posts.size());
  for (std::uint32_t row = 0; row < posts.rows; row += band) {
    const std::uint32_t rows = std::min(band, posts.rows - row);
    const std::size_t first = std::size_t{row} * posts.columns, count = std::size_t{rows} * posts.columns;
    const auto read = source.readRows(row, rows, std::span(heights).subspan(first, count),
                                      std::span(none).subspan(first, count));
    EXPECT_TRUE(read) << toString(read.findings());
    if (!read) break;
  }
  if (beyond != nullptr) *beyond = std::move(none);
  return heights;
}

}  // namespace trimtab::test
