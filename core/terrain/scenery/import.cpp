#include "trimtab/terrain/scenery/import.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "trimtab/terrain/grid/post_grid.h"
#include "trimtab/terrain/grid/progress.h"
#include "trimtab/units/number.h"

namespace trimtab::terrain {

namespace {

constexpr double kMostPosts = 4e8, kUsualPosts = 6e6;
constexpr double kFinestM = 30, kCoarsestM = 60;
constexpr double kDegreeM = 111320;
constexpr double kMostSide = 1u << 20;  ///< as the store checks
/// Posts that are looked at together.
constexpr std::size_t kBandPosts = std::size_t{1} << 21;

/// Borders of buckets are eighths of a degree, which the tiles' floats miss by a millimetre.
double snapped(double degrees) {
  const double eighth = std::round(degrees * 8) / 8;
  return std::abs(degrees - eighth) < 1e-6 ? eighth : degrees;
}

Finding nothingCovered() {
  return {Severity::error, "scenery", "", "triangles that cover ground", "none"};
}

Finding aboutSea(std::uint64_t posts) {
  return {Severity::note, "scenery", "outline", "tiles over the whole rectangle of the terrain",
          std::to_string(posts) + " posts beyond them, taken for open sea"};
}

/// `take` is called for all rows, some at a time.
Result<Done> forEachBand(const PostGrid& posts, const Progress& progress, const char* what,
                         const std::function<Result<Done>(std::uint32_t first, std::uint32_t rows)>& take) {
  const auto most = static_cast<std::uint32_t>(std::max<std::size_t>(1, kBandPosts / posts.columns));
  for (std::uint32_t first = 0; first < posts.rows; first += most) {
    if (progress && !progress(static_cast<double>(first) / posts.rows, what)) return cancelled(what);
    if (auto taken = take(first, std::min(most, posts.rows - first)); !taken) return taken;
  }
  return Done{};
}

}  // namespace

Result<PostGrid> sceneryPosts(const SceneryCatalogue& scenery, std::optional<Metres> distance) {
  const Rectangle whole = scenery.extent();
  if (whole.empty()) return nothingCovered();
  return postsOver({snapped(whole.west), snapped(whole.south), snapped(whole.east), snapped(whole.north)},
                   distance);
}

Result<PostGrid> postsOver(const Rectangle& r, std::optional<Metres> distance) {
  const double narrow = std::min(std::abs(r.south), std::abs(r.north)) * std::numbers::pi / 180;
  const double wideM = (r.east - r.west) * kDegreeM * (r.south * r.north <= 0 ? 1 : std::cos(narrow)),
               highM = (r.north - r.south) * kDegreeM;
  if (!(wideM > 0 && highM > 0)) return nothingCovered();
  double step = kFinestM;
  if (distance)
    step = distance->value();
  else
    step = std::clamp(std::sqrt(wideM * highM / kUsualPosts), kFinestM, kCoarsestM);
  const double columns = std::max(std::ceil(wideM / step), 1.0) + 1,
               rows = std::max(std::ceil(highM / step), 1.0) + 1;
  if (!(step > 0) || !(columns * rows <= kMostPosts) || !(std::max(columns, rows) <= kMostSide))
    return Finding{Severity::error, "scenery", "size",
                   "at most 400 million posts, and 1,048,576 a side, at the distance wanted",
                   numberText(columns * rows) + " posts, " + numberText(step, 6) + " m apart"};
  PostGrid posts;
  posts.west = r.west;
  posts.south = r.south;
  posts.columns = static_cast<std::uint32_t>(columns);
  posts.rows = static_cast<std::uint32_t>(rows);
  posts.stepLongitude = (r.east - r.west) / (columns - 1);
  posts.stepLatitude = (r.north - r.south) / (rows - 1);
  return posts;
}

Result<std::unique_ptr<SceneryHeights>> SceneryHeights::open(const SceneryCatalogue& scenery,
                                                             const PostGrid& posts, const Progress& progress,
                                                             std::unique_ptr<ElevationSource> elevation) {
  auto heights = std::unique_ptr<SceneryHeights>(new SceneryHeights(scenery, posts, std::move(elevation)));
  Findings notes;
  if (auto found = heights->findSea(progress); !found) return found.findings();
  if (heights->sea_ && heights->sea_->posts() > 0) notes.push_back(aboutSea(heights->sea_->posts()));
  return Result<std::unique_ptr<SceneryHeights>>(std::move(heights), std::move(notes));
}

/// Runs before what is sea is known.
Result<Done> SceneryHeights::readSources(std::uint32_t first, std::uint32_t rows, std::span<float> heights,
                                         std::span<std::uint8_t> reached) {
  if (blended_) return blended_->read(first, rows, heights, reached);
  for (std::uint32_t row = 0; row < rows; ++row)
    raster_.reached(first + row, reached.subspan(row * posts().columns, posts().columns));
  return raster_.read(first, rows, heights);
}

Result<Done> SceneryHeights::findSea(const Progress& progress) {
  const std::size_t columns = posts().columns;
  std::vector<std::uint8_t> reached(columns);
  bool all = true;
  for (std::uint32_t row = 0; all && row < posts().rows; ++row) {
    raster_.reached(row, reached);
    all = std::find(reached.begin(), reached.end(), 0) == reached.end();
  }
  if (all) return Done{};
  sea_.emplace();
  std::vector<float> heights;
  const auto take = [&](std::uint32_t first, std::uint32_t rows) -> Result<Done> {
    heights.resize(rows * columns);
    reached.resize(rows * columns);
    if (auto read = readSources(first, rows, heights, reached); !read) return read;
    for (std::uint32_t row = 0; row < rows; ++row)
      sea_->add(std::span(heights).subspan(row * columns, columns),
                std::span(reached).subspan(row * columns, columns));
    return Done{};
  };
  if (auto done = forEachBand(posts(), progress, "looking for open sea", take); !done) return done;
  sea_->finish();
  return Done{};
}

Result<Done> SceneryHeights::readRows(std::uint32_t first, std::uint32_t rows, std::span<float> heights,
                                      std::span<std::uint8_t> beyond, std::span<std::uint16_t> from) {
  std::fill(from.begin(), from.end(), kNoSource);
  reached_.resize(heights.size());
  if (auto read = readSources(first, rows, heights, reached_); !read) return read;
  std::fill(beyond.begin(), beyond.end(), std::uint8_t{0});
  if (!sea_) return Done{};
  for (std::uint32_t row = 0; row < rows; ++row)
    for (const OpenSea::Stretch& stretch : sea_->stretches(first + row)) {
      const auto start = static_cast<std::ptrdiff_t>(std::size_t{row} * posts().columns);
      if (sea_->isSea(stretch))
        std::fill(heights.begin() + start + stretch.first, heights.begin() + start + stretch.end, 0.0f);
      else if (!beyond.empty())
        std::fill(beyond.begin() + start + stretch.first, beyond.begin() + start + stretch.end,
                  std::uint8_t{1});
    }
  return Done{};
}

Result<std::vector<std::uint8_t>> SceneryHeights::image(const Progress& progress) const {
  const std::size_t columns = posts().columns;
  std::vector<std::uint8_t> image(posts().size() * 4);
  std::vector<float> heights;
  const auto take = [&](std::uint32_t first, std::uint32_t rows) -> Result<Done> {
    heights.resize(rows * columns);
    const auto band = std::span(image).subspan(first * columns * 4, rows * columns * 4);
    if (auto read = raster_.read(first, rows, heights, band); !read) return read;
    for (std::uint32_t row = 0; sea_ && row < rows; ++row)
      for (const OpenSea::Stretch& stretch : sea_->stretches(first + row))
        if (sea_->isSea(stretch)) paintSea(band.subspan(row * columns * 4, columns * 4), stretch);
    return Done{};
  };
  if (auto done = forEachBand(posts(), progress, "colours of posts", take); !done) return done.findings();
  return image;
}

}  // namespace trimtab::terrain
