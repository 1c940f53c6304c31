#include "trimtab/terrain/synthetic/land_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>

#include "landscape.h"
#include "trimtab/terrain/elevation/georeference.h"
#include "trimtab/terrain/elevation/write_tiff.h"
#include "trimtab/terrain/grid/parallel.h"
#include "trimtab/terrain/grid/post_geometry.h"
#include "trimtab/units/number.h"

namespace trimtab::terrain {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t kMostForRivers = 4096, kMostFiner = 16, kMostSide = 1u << 18;
constexpr float kSeaM = 0.02f;

using Colour = std::array<float, 3>;

Colour mixed(const Colour& a, const Colour& b, float share) {
  return {a[0] + (b[0] - a[0]) * share, a[1] + (b[1] - a[1]) * share, a[2] + (b[2] - a[2]) * share};
}

Colour scaled(const Colour& a, float by) {
  return {a[0] * by, a[1] * by, a[2] * by};
}

/// Holds what is known of a place.
struct Ground {
  double east = 0, south = 0;  ///< metres from the north-west corner
  float height = 0, slope = 0;
  float drainedM2 = 0;  ///< 0 if rivers are not known
};

/// Districts of fields, each with its own direction, between roads.
struct Farmland {
  double roadM = 0;     ///< distance to the district's edge
  double villageM = 0;  ///< distance to the edge of the village at its corner, negative in it
  Colour field{};
};

Farmland farmlandAt(const Ground& at, std::uint32_t seed) {
  constexpr double kDistrictM = 2300, kFieldLongM = 170, kFieldWideM = 75, kTrackM = 9;
  constexpr std::array<Colour, 7> kCrops{{{96, 118, 66},
                                          {112, 138, 70},
                                          {86, 108, 60},
                                          {136, 138, 88},
                                          {152, 142, 104},
                                          {128, 112, 78},
                                          {102, 130, 84}}};
  const double bendEast = 1400 * fractalNoise(at.east / 5200, at.south / 5200, 3, seed + 71),
               bendSouth = 1400 * fractalNoise(at.east / 5200, at.south / 5200, 3, seed + 76);
  const double x = (at.east + bendEast) / kDistrictM, y = (at.south + bendSouth) / kDistrictM;
  const double u = x - std::floor(x), v = y - std::floor(y);
  const auto i = static_cast<std::int32_t>(std::floor(x)), j = static_cast<std::int32_t>(std::floor(y));
  Farmland land;
  const double du = std::min(u, 1 - u) * kDistrictM, dv = std::min(v, 1 - v) * kDistrictM;
  land.roadM = std::min(du, dv);
  const auto corner = [](double place) { return static_cast<std::int32_t>(std::round(place)); };
  land.villageM = std::hypot(du, dv) - 520 * latticeNoise(corner(x), corner(y), seed + 75);
  const double turn = std::numbers::pi * latticeNoise(i, j, seed + 72);
  const double along = at.east * std::cos(turn) + at.south * std::sin(turn),
               across = at.south * std::cos(turn) - at.east * std::sin(turn);
  const double row = std::floor(across / kFieldWideM),
               shift = 80 * latticeNoise(static_cast<std::int32_t>(row), i, seed + 73);
  const double column = std::floor((along + shift) / kFieldLongM);
  const double crop =
      latticeNoise(static_cast<std::int32_t>(column), static_cast<std::int32_t>(row), seed + 74) * 0.5 + 0.5;
  const auto which = std::min(static_cast<std::size_t>(crop * kCrops.size()), kCrops.size() - 1);
  land.field = kCrops[which];
  if (across / kFieldWideM - row < kTrackM / kFieldWideM) land.field = {104, 98, 74};
  return land;
}

Colour colourOf(const Ground& at, std::uint32_t seed) {
  constexpr Colour kSea{38, 66, 92}, kShore{96, 128, 132}, kRiver{52, 82, 92}, kBank{150, 146, 122},
      kRoad{128, 126, 122}, kWood{44, 66, 38}, kHighWood{70, 84, 56}, kRock{122, 116, 108};
  const auto grain = static_cast<float>(latticeNoise(static_cast<std::int32_t>(at.east / 9),
                                                     static_cast<std::int32_t>(at.south / 9), seed + 81));
  const auto patches = static_cast<float>(fractalNoise(at.east / 700, at.south / 700, 3, seed + 82));
  if (at.height <= kSeaM) return mixed(kSea, kShore, std::clamp(0.25f + 0.35f * patches, 0.f, 1.f));
  // A river of 30 km2 is 40 m wide on posts of 60 m, and wider by the root of what it drains.
  if (at.drainedM2 > 3e7f && at.slope < 0.25f) return kRiver;
  if (at.drainedM2 > 1.5e7f && at.slope < 0.1f) return scaled(kBank, 1 + 0.06f * grain);
  const float wooded = std::clamp((at.slope - 0.10f + 0.10f * patches) / 0.05f, 0.f, 1.f),
              rocky = std::clamp((at.slope - 0.75f + 0.2f * patches) / 0.15f, 0.f, 1.f);
  const float high = std::clamp((at.height - 700) / 700, 0.f, 1.f);
  Colour colour = scaled(mixed(kWood, kHighWood, high), 1 + 0.16f * grain + 0.25f * patches);
  if (wooded < 1) {
    const Farmland farm = farmlandAt(at, seed);
    Colour open = scaled(farm.field, 1 + 0.05f * grain + 0.15f * patches);
    if (farm.villageM < 180 * double{patches}) {
      const bool roof = grain > 0.1f;
      open = roof ? Colour{150 + 30 * grain, 112, 98} : Colour{122, 124, 112};
    }
    if (farm.roadM < 9) open = kRoad;
    colour = mixed(open, colour, wooded);
  }
  return mixed(colour, scaled(kRock, 1 + 0.1f * grain), rocky);
}

/// The posts of a raster, read in rows.
class Posts {
 public:
  Posts(GDALDataset& data, std::uint32_t columns) : band_(*data.GetRasterBand(1)), columns_(columns) {
    int has = 0;
    const double value = band_.GetNoDataValue(&has);
    if (has != 0) noData_ = static_cast<float>(value);
  }
  /// Reads rows from the north; voids become 0. Returns false if GDAL fails.
  bool read(std::uint32_t first, std::uint32_t count, std::vector<float>& heights) {
    heights.resize(std::size_t{columns_} * count);
    const int columns = static_cast<int>(columns_), rows = static_cast<int>(count);
    if (band_.RasterIO(GF_Read, 0, static_cast<int>(first), columns, rows, heights.data(), columns, rows,
                       GDT_Float32, 0, 0, nullptr) != CE_None)
      return false;
    for (float& h : heights)
      if (!std::isfinite(h) || (noData_ && h == *noData_)) h = 0;
    return true;
  }

 private:
  GDALRasterBand& band_;
  std::uint32_t columns_;
  std::optional<float> noData_;
};

/// Returns the area that drains through each post, rows from the north; empty for a grid too large.
std::vector<float> drainedAreas(Posts& posts, const PostGrid& grid, double cellM, bool& failed) {
  const std::uint32_t side = std::max(grid.columns, grid.rows);
  if (side > kMostForRivers) return {};
  std::vector<float> heights;
  failed = !posts.read(0, grid.rows, heights);
  if (failed) return {};
  // Beyond the grid is sea, into which its edges drain.
  Landscape land{side, cellM, std::vector<float>(std::size_t{side} * side), {}};
  for (std::uint32_t r = 0; r < grid.rows; ++r)
    std::copy_n(&heights[std::size_t{r} * grid.columns], grid.columns, &land.heights[std::size_t{r} * side]);
  carveHollows(land);
  std::vector<float> drained(grid.size());
  for (std::uint32_t r = 0; r < grid.rows; ++r)
    std::copy_n(&land.drainedM2[std::size_t{r} * side], grid.columns,
                &drained[std::size_t{r} * grid.columns]);
  return drained;
}

/// Interpolates bilinearly between posts: `at` counts posts from the first of `values`.
float between(std::span<const float> values, std::uint32_t columns, double column, double row) {
  const auto c = static_cast<std::size_t>(column), r = static_cast<std::size_t>(row);
  const auto u = static_cast<float>(column - double(c)), v = static_cast<float>(row - double(r));
  const float* p = &values[r * columns + c];
  const float* q = p + columns;
  return (p[0] * (1 - u) + p[1] * u) * (1 - v) + (q[0] * (1 - u) + q[1] * u) * v;
}

}  // namespace

Result<Done> writeLandPicture(const fs::path& elevation, const fs::path& tif,
                              const LandPictureOptions& options) {
  useGdal();
  GdalErrors errors;
  const auto opened = openRaster(elevation, errors, RasterKind::heights);
  if (!opened) return opened.findings();
  const std::optional<PostGrid> found = geographicPosts(*opened);
  if (!found)
    return about(Severity::error, elevation, "georeference", "WGS84 degrees, north up", "another one");
  const PostGrid grid = *found;
  if (grid.columns < 2 || grid.rows < 2)
    return about(Severity::error, elevation, "posts", "at least 2 a side",
                 std::to_string(grid.columns) + " x " + std::to_string(grid.rows));
  const PostGeometry middle({grid.longitude(grid.columns / 2), grid.latitude(grid.rows / 2),
                             grid.stepLongitude, grid.stepLatitude, 2, 2});
  const double postM = middle.rowM(0);
  if (!(options.pixelM > 0))
    return about(Severity::error, tif, "pixel", "a size above 0 m", numberText(options.pixelM) + " m");
  const auto finer =
      static_cast<std::uint32_t>(std::clamp(std::round(postM / options.pixelM), 1.0, double{kMostFiner}));
  if (std::max(grid.columns, grid.rows) * std::uint64_t{finer} > kMostSide)
    return about(Severity::error, tif, "pixels", "at most " + std::to_string(kMostSide) + " a side",
                 std::to_string(std::max(grid.columns, grid.rows) * std::uint64_t{finer}));
  // Pixels lie within the posts, a whole number of them from post to post.
  PostGrid pixels = grid;
  pixels.columns = (grid.columns - 1) * finer;
  pixels.rows = (grid.rows - 1) * finer;
  pixels.stepLongitude /= finer;
  pixels.stepLatitude /= finer;
  pixels.west += pixels.stepLongitude / 2;
  pixels.south += pixels.stepLatitude / 2;

  const std::string what = "painting " + tif.filename().string();
  const auto carryOn = [&](double done) { return !options.progress || options.progress(done, what); };
  Posts posts(*opened->data, grid.columns);
  bool failed = false;
  if (!carryOn(0)) return cancelled(tif.string());
  const std::vector<float> drained = drainedAreas(posts, grid, postM, failed);
  const double columnM = middle.columnM(0), pixelEastM = columnM / finer, pixelSouthM = postM / finer;
  std::vector<float> heights;
  const auto done =
      writePicture(tif, pixels, [&](std::uint32_t first, std::uint32_t count, std::span<std::uint8_t> rgb) {
        const std::uint32_t top = first / finer,
                            bottom = std::min((first + count - 1) / finer + 1, grid.rows - 1);
        failed = failed || !posts.read(top, bottom - top + 1, heights);
        if (failed) return false;
        const std::span<const float> area = drained.empty()
                                                ? std::span<const float>()
                                                : std::span(drained).subspan(std::size_t{top} * grid.columns);
        const auto row = [&](std::uint32_t r) {
          const double y = (first + r + 0.5) / finer - top;
          for (std::uint32_t c = 0; c < pixels.columns; ++c) {
            const double x = (c + 0.5) / finer;
            const auto i = static_cast<std::size_t>(y) * grid.columns + static_cast<std::size_t>(x);
            const float* p = &heights[i];
            const double dx = (p[1] + p[grid.columns + 1] - p[0] - p[grid.columns]) / (2 * columnM),
                         dy = (p[grid.columns] + p[grid.columns + 1] - p[0] - p[1]) / (2 * postM);
            const Ground at{.east = c * pixelEastM,
                            .south = (first + r) * pixelSouthM,
                            .height = between(heights, grid.columns, x, y),
                            .slope = static_cast<float>(std::hypot(dx, dy)),
                            .drainedM2 = area.empty() ? 0 : between(area, grid.columns, x, y)};
            const Colour colour = colourOf(at, options.seed);
            for (std::size_t k = 0; k < 3; ++k)
              rgb[3 * (std::size_t{r} * pixels.columns + c) + k] =
                  static_cast<std::uint8_t>(std::clamp(colour[k], 0.f, 255.f));
          }
        };
        return forEachParallel(count, row,
                               [&](double f) { return carryOn((first + f * count) / pixels.rows); });
      });
  if (failed)
    return about(Severity::error, elevation, "", "heights that can be read",
                 errors.last("GDAL gives no reason"));
  return done;
}

}  // namespace trimtab::terrain
