#include "trimtab/terrain/synthetic/country.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "landscape.h"
#include "trimtab/terrain/elevation/georeference.h"
#include "trimtab/terrain/elevation/write_tiff.h"
#include "trimtab/terrain/grid/parallel.h"
#include "trimtab/units/number.h"

namespace trimtab::terrain {

namespace {

namespace fs = std::filesystem;

constexpr double kLatitude = 36.63, kLongitude = 128.35;
/// A country of 65536 posts a side is as large as a GeoTIFF's tiles and a bake's patience allow.
constexpr std::uint32_t kMostSide = 65536;

/// Returns the metres at a place in metres: ranges some 40 km apart, as high as the land is broad there,
/// rough to the distance of posts.
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
    return about(Severity::error, tif, "distance of posts", "1 to 2000 m", numberText(options.postM) + " m");
  PostGrid posts;
  posts.columns = options.columns, posts.rows = options.rows;
  posts.stepLatitude = options.postM / 110980;
  posts.stepLongitude = options.postM / (111320 * std::cos(kLatitude * std::numbers::pi / 180));
  posts.west = kLongitude - posts.stepLongitude * (posts.columns - 1) / 2;
  posts.south = kLatitude - posts.stepLatitude * (posts.rows - 1) / 2;
  const double end = posts.latitude(posts.rows - 1.0), wide = posts.stepLongitude * posts.columns;
  if (end > 90)
    return about(Severity::error, tif, "rows",
                 "at most " +
                     std::to_string(static_cast<int>(2 * (90 - kLatitude) / posts.stepLatitude) + 1) +
                     " at this distance, so that the land ends before the pole",
                 std::to_string(posts.rows));
  if (wide > 360)
    return about(Severity::error, tif, "columns",
                 "at most " + std::to_string(static_cast<int>(360 / posts.stepLongitude)) +
                     " at this distance, so that the land goes round the earth once",
                 std::to_string(posts.columns));
  return writeTiff(tif, posts, [&](std::uint32_t first, std::uint32_t count, std::span<float> heights) {
    const auto row = [&](std::uint32_t r) {
      float* out = &heights[std::size_t{r} * options.columns];
      const double north = (posts.rows - 1.0 - first - r) * options.postM;
      // Broad features change little from post to post.
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
    };
    return forEachParallel(count, row, [&](double f) {
      return !options.progress || options.progress((first + f * count) / posts.rows, "shaping the country");
    });
  });
}

}  // namespace trimtab::terrain
