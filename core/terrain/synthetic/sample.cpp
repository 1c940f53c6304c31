#include <algorithm>
#include <cmath>

#include "landscape.h"
#include "trimtab/terrain/elevation/write_tiff.h"
#include "trimtab/terrain/grid/post_geometry.h"
#include "trimtab/terrain/grid/post_grid.h"
#include "trimtab/terrain/grid/progress.h"
#include "trimtab/terrain/synthetic/sample.h"
#include "trimtab/units/number.h"
#include "world.h"

namespace trimtab::terrain {

namespace {

namespace fs = std::filesystem;

constexpr double kLatitude = 36.63, kLongitude = 128.35;
constexpr double kAirfieldM = 108;  ///< height of the flat in the middle
constexpr double kMostSide = 12000;

double smoothStep(double low, double high, double x) {
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

double flatRadius(double sizeM) {
  return std::min(2800.0, 0.06 * sizeM);
}

double fromMiddle(const Landscape& land, std::uint32_t row, std::uint32_t column) {
  const double half = (land.side - 1) / 2.0;
  return std::hypot(row - half, column - half) * land.cellM;
}

/// Fits the heights of the process to the country: the valley by the middle at 102 m, the highest peak at
/// 1,500 m (less on a small square). The map is monotone: water still runs to the sea.
void fitHeights(Landscape& land, double sizeM) {
  const float highest = *std::max_element(land.heights.begin(), land.heights.end());
  float valley = highest;
  for (std::uint32_t r = 0; r < land.side; ++r)
    for (std::uint32_t c = 0; c < land.side; ++c) {
      const float h = land.heights[std::size_t{r} * land.side + c];
      if (fromMiddle(land, r, c) < 0.08 * sizeM && h > 0) valley = std::min(valley, h);
    }
  const double peak = 1500 * std::clamp(std::sqrt(sizeM / 1e5), 0.25, 1.5), floor = 102;
  const double bend = std::clamp(std::log(floor / peak) / std::log(valley / highest), 0.4, 3.0);
  for (float& h : land.heights) h = static_cast<float>(peak * std::pow(h / highest, bend));
}

void flattenAirfield(Landscape& land, double sizeM) {
  const double flat = flatRadius(sizeM), hills = std::min(7500.0, 0.16 * sizeM);
  for (std::uint32_t r = 0; r < land.side; ++r)
    for (std::uint32_t c = 0; c < land.side; ++c) {
      float& h = land.heights[std::size_t{r} * land.side + c];
      const double t = smoothStep(flat, hills, fromMiddle(land, r, c));
      if (h > 0) h = static_cast<float>(kAirfieldM + (h - kAirfieldM) * t);
    }
}

/// Rivers lie in floors as wide as the water they carry, not in notches one post wide.
void widenValleys(Landscape& land, double sizeM, std::uint32_t seed) {
  constexpr float kFar = 2;
  std::vector<float> away(land.heights.size(), kFar), beds(land.heights.size(), 0);
  const auto side = static_cast<std::int32_t>(land.side);
  for (std::int32_t r = 0; r < side; ++r)
    for (std::int32_t c = 0; c < side; ++c) {
      const std::size_t i = static_cast<std::size_t>(r) * land.side + static_cast<std::size_t>(c);
      const double km2 = land.drainedM2[i] / 1e6;
      if (km2 < 4 || land.heights[i] <= 0) continue;
      if (fromMiddle(land, static_cast<std::uint32_t>(r), static_cast<std::uint32_t>(c)) < flatRadius(sizeM))
        continue;
      const double vary = 1 + 0.9 * fractalNoise(c * land.cellM / 2500, r * land.cellM / 2500, 3, seed + 71);
      const double wide = std::min(1100.0, 60 * std::pow(km2 / 10, 0.45)) * vary;
      const double bed = land.heights[i] - std::min(4.0, 0.8 * std::pow(km2 / 10, 0.3));
      const auto span = static_cast<std::int32_t>(wide * kFar / land.cellM);
      for (std::int32_t y = std::max(0, r - span); y <= std::min(side - 1, r + span); ++y)
        for (std::int32_t x = std::max(0, c - span); x <= std::min(side - 1, c + span); ++x) {
          const std::size_t k = static_cast<std::size_t>(y) * land.side + static_cast<std::size_t>(x);
          const auto t = static_cast<float>(std::hypot(y - r, x - c) * land.cellM / wide);
          if (t < away[k]) away[k] = t, beds[k] = static_cast<float>(bed);
        }
    }
  for (std::size_t k = 0; k < away.size(); ++k) {
    float& h = land.heights[k];
    if (away[k] >= kFar || h <= 0) continue;
    const float floor = std::max(0.25f, beds[k] + 2 * away[k] * away[k]);
    if (h > floor) h = floor + (h - floor) * static_cast<float>(smoothStep(0.15, kFar, away[k]));
  }
}

/// Creep rounds what the steps of the process left.
void soften(Landscape& land) {
  const std::vector<float> before = land.heights;
  const std::size_t side = land.side;
  for (std::size_t r = 1; r + 1 < side; ++r)
    for (std::size_t c = 1; c + 1 < side; ++c) {
      const std::size_t i = r * side + c;
      if (before[i] <= 0) continue;
      const float around = (before[i - 1] + before[i + 1] + before[i - side] + before[i + side]) / 4;
      const float corners =
          (before[i - side - 1] + before[i - side + 1] + before[i + side - 1] + before[i + side + 1]) / 4;
      land.heights[i] = 0.4f * before[i] + 0.4f * around + 0.2f * corners;
    }
}

}  // namespace

fs::path sampleObjects(const fs::path& tif) {
  return tif.parent_path() / (tif.stem().string() + "-objects.csv");
}

Result<Done> writeSample(const fs::path& tif, const SampleOptions& options) {
  const double sizeM = options.sizeKm * 1000;
  const double side = std::round(sizeM / options.postM) + 1;
  if (!(options.sizeKm >= 5 && options.sizeKm <= 1000))
    return Finding{Severity::error, tif.string(), "size", "5 to 1000 km", numberText(options.sizeKm) + " km"};
  if (!(options.postM > 0) || !(side >= 33 && side <= kMostSide))
    return Finding{Severity::error, tif.string(), "posts", "33 to 12000 a side", numberText(side)};

  const LandscapeShape shape{static_cast<std::uint32_t>(side), options.postM, options.seed};
  Landscape land = erodedLandscape(
      shape, [&](double f) { return !options.progress || options.progress(0.9 * f, "shaping the sample"); });
  if (land.heights.empty()) return cancelled(tif.string());
  fitHeights(land, sizeM);
  flattenAirfield(land, sizeM);
  widenValleys(land, sizeM, options.seed);
  soften(land);
  carveHollows(land);
  // A stream that was cut through the airfield runs under it.
  for (std::uint32_t r = 0; r < land.side; ++r)
    for (std::uint32_t c = 0; c < land.side; ++c)
      if (fromMiddle(land, r, c) < flatRadius(sizeM))
        land.heights[std::size_t{r} * land.side + c] = kAirfieldM;
  // Steps of 1/64 m: exact in the file, and what a person reads is short.
  for (float& h : land.heights) h = std::round(h * 64) / 64;
  if (options.progress && !options.progress(0.95, "writing the sample")) return cancelled(tif.string());

  const PostGeometry middle({kLongitude, kLatitude, 1, 1, 2, 2});
  PostGrid posts;
  posts.columns = posts.rows = shape.side;
  posts.stepLongitude = options.postM / middle.columnM(0);
  posts.stepLatitude = options.postM / middle.rowM(0);
  posts.west = kLongitude - posts.stepLongitude * (shape.side - 1) / 2;
  posts.south = kLatitude - posts.stepLatitude * (shape.side - 1) / 2;
  // What this call makes goes again if the sample cannot be completed; what was there before stays.
  const fs::path list = sampleObjects(tif), models = list.parent_path() / list.stem();
  std::error_code ignored;
  const bool hadList = fs::exists(list, ignored), hadModels = fs::exists(models, ignored);
  const auto cleared = [&](Result<Done> done) {
    if (done || !options.objects) return done;
    if (!hadList) fs::remove(list, ignored);
    if (!hadModels) fs::remove_all(models, ignored);
    return done;
  };
  if (options.objects)
    if (const auto done = writeWorld(list, {land, posts, flatRadius(sizeM), options.seed}); !done)
      return cleared(done);
  return cleared(
      writeTiff(tif, posts, [&](std::uint32_t first, std::uint32_t count, std::span<float> heights) {
        for (std::uint32_t r = 0; r < count; ++r)
          std::copy_n(&land.heights[std::size_t{land.side - 1 - first - r} * land.side], land.side,
                      &heights[std::size_t{r} * land.side]);
        return true;
      }));
}

}  // namespace trimtab::terrain
