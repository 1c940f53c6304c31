#include <cpl_string.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "trimtab/terrain/import.h"

namespace trimtab::terrain {

namespace {

constexpr float kVoid = std::numeric_limits<float>::quiet_NaN();
constexpr double kMostPosts = 4e8;

/// Whole posts and parts of one between; posts that coincide within a thousandth are the same.
struct Place {
  std::uint32_t post = 0;
  float part = 0;
  bool inside = false;
};

Place placeOf(double x, std::uint32_t count) {
  const double whole = std::round(x);
  if (std::abs(x - whole) < 1e-3) x = whole;
  if (!(x >= 0 && x <= count - 1.0)) return {};
  const auto post = std::min(static_cast<std::uint32_t>(x), count - 2);
  return {post, static_cast<float>(x - post), true};
}

/// Between four posts; a void counts only where it has weight.
float between(const HeightGrid& part, const Place& row, const Place& column) {
  float sum = 0;
  for (const std::uint32_t j : {0u, 1u})
    for (const std::uint32_t i : {0u, 1u}) {
      const float weight = (j ? row.part : 1 - row.part) * (i ? column.part : 1 - column.part);
      if (weight > 0)
        sum += weight * part.heights[std::size_t{row.post + j} * part.posts.columns + column.post + i];
    }
  return sum;
}

}  // namespace

Result<HeightGrid> mosaic(std::vector<HeightGrid> parts, const Progress& progress) {
  if (parts.size() == 1) return Result<HeightGrid>(std::move(parts.front()));
  // Finer parts first: where a coarse file and a fine one overlap, the fine one tells. Steps within 1 % are
  // alike.
  const auto fineness = [](const HeightGrid& part) {
    return std::lround(100 * std::log(part.posts.stepLatitude));
  };
  std::stable_sort(parts.begin(), parts.end(),
                   [&](const HeightGrid& a, const HeightGrid& b) { return fineness(a) < fineness(b); });
  // Longitudes of all parts on the first one's side of the earth.
  const double reference = parts.front().posts.west;
  for (HeightGrid& part : parts)
    part.posts.west = reference + std::remainder(part.posts.west - reference, 360.0);
  PostGrid whole = parts.front().posts;
  double east = whole.west, north = whole.south;
  for (const HeightGrid& part : parts) {
    const PostGrid& p = part.posts;
    east = std::max(east, p.longitude(p.columns - 1));
    north = std::max(north, p.latitude(p.rows - 1));
    whole.west = std::min(whole.west, p.west);
    whole.south = std::min(whole.south, p.south);
    whole.stepLongitude = std::min(whole.stepLongitude, p.stepLongitude);
    whole.stepLatitude = std::min(whole.stepLatitude, p.stepLatitude);
  }
  const double columns = std::round((east - whole.west) / whole.stepLongitude) + 1;
  const double rows = std::round((north - whole.south) / whole.stepLatitude) + 1;
  if (!(columns * rows <= kMostPosts))
    return Finding{Severity::error, "all files together", "size",
                   "at most 400 million posts at the finest spacing",
                   CPLSPrintf("%.0f x %.0f", columns, rows)};
  whole.columns = static_cast<std::uint32_t>(columns);
  whole.rows = static_cast<std::uint32_t>(rows);

  std::vector<std::uint8_t> reached(whole.size(), 0);
  HeightGrid grid{whole, std::vector<float>(whole.size(), kVoid), 0, {}};
  for (std::size_t k = 0; k < parts.size(); ++k) {
    if (progress && !progress(static_cast<double>(k) / static_cast<double>(parts.size()), "joining files"))
      return cancelled("joining files");
    const HeightGrid& part = parts[k];
    std::vector<Place> across(whole.columns);
    for (std::uint32_t c = 0; c < whole.columns; ++c)
      across[c] =
          placeOf((whole.longitude(c) - part.posts.west) / part.posts.stepLongitude, part.posts.columns);
    for (std::uint32_t r = 0; r < whole.rows; ++r) {
      const Place row =
          placeOf((whole.latitude(r) - part.posts.south) / part.posts.stepLatitude, part.posts.rows);
      if (!row.inside) continue;
      for (std::uint32_t c = 0; c < whole.columns; ++c) {
        float& height = grid.heights[std::size_t{r} * whole.columns + c];
        if (!across[c].inside) continue;
        reached[std::size_t{r} * whole.columns + c] = 1;
        if (std::isnan(height)) height = between(part, row, across[c]);
      }
    }
  }
  grid.outside = static_cast<std::uint64_t>(std::count(reached.begin(), reached.end(), 0));
  return Result<HeightGrid>(std::move(grid));
}

}  // namespace trimtab::terrain
