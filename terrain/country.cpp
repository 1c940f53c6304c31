#include "trimtab/terrain/country.h"

#include <gdal_priv.h>
#include <ogr_spatialref.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "trimtab/terrain/georeference.h"
#include "trimtab/terrain/import.h"
#include "trimtab/terrain/landscape.h"
#include "trimtab/terrain/parallel.h"

namespace trimtab::terrain {

namespace {

namespace fs = std::filesystem;

constexpr double kLatitude = 36.63, kLongitude = 128.35;
constexpr int kTile = 256;
/// A country of 65536 posts a side is as large as a GeoTIFF's tiles and a bake's patience allow.
constexpr std::uint32_t kMostSide = 65536;

/// Metres at a place in metres: ranges some 40 km apart, as high as the land is broad there, rough to the
/// distance of posts.
double heightAt(double east, double north, double range, double finest, std::uint32_t seed) {
  const int octaves = std::max(1, static_cast<int>(std::ceil(std::log2(4000 / finest))));
  const double broad = range + 0.15;
  if (broad <= -0.25) return 0;
  const double hills = fractalNoise(east / 4000, north / 4000, octaves, seed + 17);
  const double height =
      900 * broad * broad * broad + 650 * std::max(0.0, broad) * hills + 90 * broad + 25 * hills;
  return std::max(0.0, height);
}

}  // namespace

Result<Done> writeCountry(const fs::path& tif, const CountryOptions& options) {
  if (options.columns < 33 || options.rows < 33 || options.columns > kMostSide || options.rows > kMostSide)
    return about(Severity::error, tif, "posts", "33 to " + std::to_string(kMostSide) + " a side",
                 std::to_string(options.columns) + " x " + std::to_string(options.rows));
  if (!(options.postM >= 1 && options.postM <= 2000))
    return about(Severity::error, tif, "distance of posts", "1 to 2000 m", std::to_string(options.postM));
  useGdal();
  GdalErrors errors;
  const fs::path unfinished =
      tif.parent_path() / ("." + tif.filename().string() + ".part-" + std::to_string(::getpid()));
  const auto failed = [&](const std::string& otherwise) {
    std::error_code ignored;
    fs::remove(unfinished, ignored);
    return about(Severity::error, tif, "", "a GeoTIFF to be written", errors.last(otherwise));
  };
  const double stepLatitude = options.postM / 110980;
  const double stepLongitude = options.postM / (111320 * std::cos(kLatitude * std::numbers::pi / 180));
  const int columns = static_cast<int>(options.columns), rows = static_cast<int>(options.rows);
  bool stopped = false;
  {
    std::array<const char*, 3> create{"TILED=YES", "BIGTIFF=IF_SAFER", nullptr};
    Dataset data = owned(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
        unfinished.c_str(), columns, rows, 1, GDT_Float32, const_cast<char**>(create.data())));
    if (!data) return failed("GDAL gives no reason");
    std::array<double, 6> corner{kLongitude - stepLongitude * columns / 2,
                                 stepLongitude,
                                 0,
                                 kLatitude + stepLatitude * rows / 2,
                                 0,
                                 -stepLatitude};
    OGRSpatialReference crs;
    crs.importFromEPSG(4326);
    data->SetGeoTransform(corner.data());
    data->SetSpatialRef(&crs);
    data->SetMetadataItem(GDALMD_AREA_OR_POINT, GDALMD_AOP_POINT);
    GDALRasterBand* band = data->GetRasterBand(1);
    band->SetUnitType("m");
    std::vector<float> heights(std::size_t{options.columns} * kTile);
    for (int first = 0; first < rows && !stopped; first += kTile) {
      const int count = std::min(kTile, rows - first);
      stopped = !forEachParallel(
          static_cast<std::uint32_t>(count),
          [&](std::uint32_t r) {
            float* out = &heights[std::size_t{r} * options.columns];
            const double north = (rows - 1.0 - first - r) * options.postM;
            // What is broad changes little from post to post.
            constexpr std::uint32_t kStep = 32;
            double range = 0, slope = 0;
            for (std::uint32_t c = 0; c < options.columns; ++c) {
              const double east = c * options.postM;
              if (c % kStep == 0) {
                const auto broad = [&](double x) {
                  return fractalNoise(x / 90000, north / 90000, 4, options.seed);
                };
                range = c == 0 ? broad(east) : range + slope;
                slope = (broad(east + kStep * options.postM) - range) / kStep;
              } else {
                range += slope;
              }
              const double h = heightAt(east, north, range, 2.5 * options.postM, options.seed);
              out[c] = static_cast<float>(std::round(h * 64) / 64);
            }
          },
          [&](double f) {
            return !options.progress || options.progress((first + f * count) / rows, "shaping the country");
          });
      if (stopped) break;
      if (band->RasterIO(GF_Write, 0, first, columns, count, heights.data(), columns, count, GDT_Float32, 0,
                         0, nullptr) != CE_None)
        return failed("GDAL gives no reason");
      // Full rows of tiles go to the file, not to the cache.
      data->FlushCache();
      if (CPLGetLastErrorType() == CE_Failure) return failed(CPLGetLastErrorMsg());
    }
  }
  std::error_code error;
  if (stopped) {
    fs::remove(unfinished, error);
    return cancelled(tif.string());
  }
  fs::rename(unfinished, tif, error);
  if (error) return failed(error.message());
  return Done{};
}

}  // namespace trimtab::terrain
