#include "trimtab/terrain/scenery_blend.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace trimtab::terrain {

namespace {

constexpr std::uint8_t kBandPosts = 32;
constexpr int kSweeps = 150;
constexpr double kOverRelaxation = 1.8;

}  // namespace

double heightOf(const HeightGrid& grid, double longitude, double latitude) {
  const PostGrid& posts = grid.posts;
  // Places on the grid's own border, computed another way, may be a rounding beyond it.
  constexpr double kSlack = 1e-6;
  const double turn = std::remainder(longitude - posts.west, 360.0);
  const double c = (turn < -kSlack ? turn + 360 : turn) / posts.stepLongitude,
               r = (latitude - posts.south) / posts.stepLatitude;
  if (!(c >= -kSlack && r >= -kSlack && c <= posts.columns - 1 + kSlack && r <= posts.rows - 1 + kSlack))
    return std::numeric_limits<double>::quiet_NaN();
  const double lastC = posts.columns - 1, lastR = posts.rows - 1;
  const double fc = std::clamp(c, 0.0, lastC), fr = std::clamp(r, 0.0, lastR);
  const auto c0 = static_cast<std::size_t>(fc), r0 = static_cast<std::size_t>(fr);
  const std::size_t c1 = std::min<std::size_t>(c0 + 1, posts.columns - 1),
                    r1 = std::min<std::size_t>(r0 + 1, posts.rows - 1);
  const double x = fc - static_cast<double>(c0), y = fr - static_cast<double>(r0);
  double sum = 0, weight = 0;
  const auto add = [&](std::size_t row, std::size_t column, double w) {
    const float z = grid.heights[row * posts.columns + column];
    if (w <= 0 || std::isnan(z)) return;
    sum += w * static_cast<double>(z);
    weight += w;
  };
  add(r0, c0, (1 - x) * (1 - y));
  add(r0, c1, x * (1 - y));
  add(r1, c0, (1 - x) * y);
  add(r1, c1, x * y);
  return weight > 0 ? sum / weight : std::numeric_limits<double>::quiet_NaN();
}

void blendElevation(HeightGrid& grid, const HeightGrid& elevation, std::vector<std::uint8_t>& reached) {
  const PostGrid& posts = grid.posts;
  const std::size_t columns = posts.columns;
  const auto beside = [&](std::size_t post, const auto& visit) {
    const std::size_t column = post % columns, row = post / columns;
    if (column > 0) visit(post - 1);
    if (column + 1 < columns) visit(post + 1);
    if (row > 0) visit(post - columns);
    if (row + 1 < posts.rows) visit(post + columns);
  };
  // Steps from the nearest post that was there, up to one beyond the band; 255: nothing to blend.
  std::vector<std::uint8_t> away(posts.size(), 255);
  std::vector<std::size_t> filled;
  for (std::size_t i = 0; i < posts.size(); ++i) {
    if (!std::isnan(grid.heights[i])) continue;
    const double z = heightOf(elevation, posts.longitude(static_cast<double>(i % columns)),
                              posts.latitude(static_cast<double>(i / columns)));
    if (std::isnan(z)) continue;
    filled.push_back(i);
    away[i] = kBandPosts + 1;
    grid.heights[i] = static_cast<float>(z);
    reached[i] = 1;
  }
  // What the posts that were there differ by is known where they meet the others.
  std::vector<float> difference(posts.size(), 0);
  std::vector<std::size_t> band, front, next;
  for (const std::size_t i : filled)
    beside(i, [&](std::size_t j) {
      if (away[j] != 255 || std::isnan(grid.heights[j])) return;
      const double z = heightOf(elevation, posts.longitude(static_cast<double>(j % columns)),
                                posts.latitude(static_cast<double>(j / columns)));
      if (std::isnan(z)) return;
      difference[j] = grid.heights[j] - static_cast<float>(z);
      away[j] = 0;
      front.push_back(j);
    });
  for (std::uint8_t step = 1; step <= kBandPosts && !front.empty(); ++step) {
    next.clear();
    for (const std::size_t i : front)
      beside(i, [&](std::size_t j) {
        if (away[j] == 255 || away[j] <= step) return;
        away[j] = step;
        next.push_back(j);
        band.push_back(j);
      });
    front.swap(next);
  }
  std::sort(band.begin(), band.end());
  for (int sweep = 0; sweep < kSweeps; ++sweep)
    for (const std::size_t i : band) {
      double sum = 0;
      int count = 0;
      beside(i, [&](std::size_t j) {
        if (away[j] == 255) return;
        sum += static_cast<double>(difference[j]);
        ++count;
      });
      if (count == 0) continue;
      const double was = static_cast<double>(difference[i]);
      difference[i] = static_cast<float>(was + kOverRelaxation * (sum / count - was));
    }
  for (const std::size_t i : band) grid.heights[i] += difference[i];
}

}  // namespace trimtab::terrain
