#include "trimtab/terrain/scenery_merge.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "trimtab/terrain/elevation_source.h"
#include "trimtab/terrain/import.h"
#include "trimtab/terrain/scenery_made.h"
#include "trimtab/terrain/voids.h"

namespace trimtab::terrain {

namespace {

constexpr double kDegreeM = 111320;
constexpr double kMostPosts = 1e8;  ///< where no distance was given

Rectangle rectangleOf(const PostGrid& posts) {
  return {posts.west, posts.south, posts.longitude(posts.columns - 1), posts.latitude(posts.rows - 1)};
}

Result<HeightGrid> wholeOf(ElevationSource& source) {
  HeightGrid grid;
  grid.posts = source.posts();
  if (grid.posts.size() > std::size_t{400000000})
    return Finding{Severity::error, "elevation", "size", "at most 400 million posts beside scenery",
                   std::to_string(grid.posts.size())};
  grid.heights.resize(grid.posts.size());
  constexpr std::uint32_t kBand = 64;
  for (std::uint32_t first = 0; first < grid.posts.rows; first += kBand) {
    const std::uint32_t rows = std::min(kBand, grid.posts.rows - first);
    const std::span<float> heights(grid.heights.data() + std::size_t{first} * grid.posts.columns,
                                   std::size_t{rows} * grid.posts.columns);
    if (auto read = source.readRows(first, rows, heights); !read) return read.findings();
  }
  return grid;
}

/// Over both, as fine as the finer.
Result<PostGrid> postsOfBoth(const PostGrid& scenery, const PostGrid& elevation,
                             std::optional<Metres> distance) {
  Rectangle a = rectangleOf(scenery);
  const Rectangle b = rectangleOf(elevation);
  const double turn = 360 * std::round((a.west + a.east - b.west - b.east) / 720);
  a = {std::min(a.west, b.west + turn), std::min(a.south, b.south), std::max(a.east, b.east + turn),
       std::max(a.north, b.north)};
  if (!distance) {
    const double step = std::min(scenery.stepLatitude, elevation.stepLatitude);
    const double posts = (a.east - a.west) * (a.north - a.south) / (step * step);
    distance = Metres{std::max(1.0, kDegreeM * step * std::sqrt(std::max(1.0, posts / kMostPosts)))};
  }
  return postsOver(a, distance);
}

}  // namespace

Result<MergedScenery> merged(std::unique_ptr<SceneryCatalogue> scenery, const HeightGrid& elevation,
                             std::optional<Metres> distance, const Progress& progress) {
  MergedScenery all;
  all.counts = scenery->counts();
  const auto own = sceneryPosts(*scenery, distance);
  if (!own) return own.findings();
  const auto posts = postsOfBoth(*own, elevation.posts, distance);
  if (!posts) return posts.findings();
  auto grid = rasterised(*scenery, *posts, stageOf(progress, 0, 0.6), &elevation);
  if (!grid) return grid.findings();
  Findings findings = grid.findings();
  all.grid = std::move(grid).value();
  const std::uint64_t filled = fillVoids(all.grid), outside = std::min(filled, all.grid.outside);
  all.voidsFilled = filled - outside;
  if (outside > 0)
    findings.push_back({Severity::note, "scenery and elevation", "outline",
                        "tiles or heights over the whole rectangle of the terrain",
                        std::to_string(outside) + " posts beyond them, continued from their edges"});
  if (progress && !progress(0.7, "tiles between scenery")) return cancelled("tiles between scenery");
  Rectangle where = rectangleOf(elevation.posts);
  const Rectangle whole = rectangleOf(all.grid.posts);
  where = where.turned(360 * std::round((whole.west + whole.east - where.west - where.east) / 720));
  where = {std::max(where.west, whole.west), std::max(where.south, whole.south),
           std::min(where.east, whole.east), std::min(where.north, whole.north)};
  auto made = madeTiles(*scenery, all.grid, where);
  if (!made) return made.findings();
  for (SceneryMesh& mesh : *made) scenery->add(std::move(mesh));
  all.tiles = std::move(scenery);
  return Result<MergedScenery>(std::move(all), std::move(findings));
}

Result<MergedScenery> importMerged(std::span<const std::filesystem::path> scenery,
                                   std::span<const std::filesystem::path> elevation,
                                   std::optional<Metres> distance, const Progress& progress) {
  auto tiles =
      SceneryCatalogue::open(scenery, std::numeric_limits<std::size_t>::max(), stageOf(progress, 0, 0.3));
  if (!tiles) return tiles.findings();
  ElevationOptions options;
  options.progress = stageOf(progress, 0.3, 0.5);
  const auto source = openElevation(elevation, options);
  if (!source) return source.findings();
  Findings findings = tiles.findings();
  findings.insert(findings.end(), source.findings().begin(), source.findings().end());
  const auto heights = wholeOf(**source);
  if (!heights) return heights.findings();
  auto both = merged(std::move(tiles).value(), *heights, distance, stageOf(progress, 0.5, 1));
  findings.insert(findings.end(), both.findings().begin(), both.findings().end());
  if (!both) return findings;
  return Result<MergedScenery>(std::move(both).value(), std::move(findings));
}

}  // namespace trimtab::terrain
