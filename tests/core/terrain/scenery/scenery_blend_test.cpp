#include "trimtab/terrain/scenery/blend.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/terrain/bake/heights.h"
#include "scenery_tiles.h"
#include "trimtab/terrain/grid/grid_height.h"

/// Elevation beside scenery, a few rows at a time.
namespace trimtab {
namespace {

using terrain::HeightGrid;

/// The whole grid at once, as the definition says: what rows in hand must come to.
void blendWhole(HeightGrid& grid, const HeightGrid& elevation, std::vector<std::uint8_t>& reached) {
  constexpr std::uint8_t kBand = 32, kNone = 255;
  const std::size_t columns = grid.posts.columns;
  const auto beside = [&](std::size_t post, const auto& visit) {
    if (post % columns > 0) visit(post - 1);
    if (post % columns + 1 < columns) visit(post + 1);
    if (post >= columns) visit(post - columns);
    if (post + columns < grid.posts.size()) visit(post + columns);
  };
  const auto elevationAt = [&](std::size_t post) {
    return terrain::heightOf(elevation.posts, grid.posts.longitude(static_cast<double>(post % columns)),
                             grid.posts.latitude(static_cast<double>(post / columns)),
                             [&](std::size_t row, std::size_t column) {
                               return elevation.heights[row * elevation.posts.columns + column];
                             });
  };
  std::vector<std::uint8_t> away(grid.posts.size(), kNone);
  std::vector<std::size_t> filled, band, front, next;
  for (std::size_t i = 0; i < grid.posts.size(); ++i) {
    const double z = std::isnan(grid.heights[i]) ? elevationAt(i) : std::nan("");
    if (std::isnan(z)) continue;
    filled.push_back(i);
    away[i] = kBand + 1;
    grid.heights[i] = static_cast<float>(z);
    reached[i] = 1;
  }
  std::vector<float> difference(grid.posts.size(), 0);
  for (const std::size_t i : filled)
    beside(i, [&](std::size_t j) {
      if (away[j] != kNone || std::isnan(grid.heights[j]) || std::isnan(elevationAt(j))) return;
      difference[j] = grid.heights[j] - static_cast<float>(elevationAt(j));
      away[j] = 0;
      front.push_back(j);
    });
  for (std::uint8_t step = 1; step <= kBand; ++step) {
    next.clear();
    for (const std::size_t i : front)
      beside(i, [&](std::size_t j) {
        if (away[j] == kNone || away[j] <= step) return;
        away[j] = step;
        next.push_back(j);
        band.push_back(j);
      });
    front.swap(next);
  }
  std::sort(band.begin(), band.end());
  for (int sweep = 0; sweep < 150; ++sweep)
    for (const std::size_t i : band) {
      double sum = 0;
      int count = 0;
      beside(i, [&](std::size_t j) {
        if (away[j] == kNone) return;
        sum += static_cast<double>(difference[j]);
        ++count;
      });
      const double was = static_cast<double>(difference[i]);
      difference[i] = static_cast<float>(was + 1.8 * (sum / count - was));
    }
  for (const std::size_t i : band) grid.heights[i] += difference[i];
}

bool same(float a, float b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

TEST(BlendedRows, areTheWholeGridsToTheBitInAnyPortions) {
  std::vector<terrain::SceneryMesh> meshes;
  for (const auto& [column, row] : {std::pair{0, 0}, {2, 0}, {0, 1}, {1, 1}, {3, 2}}) {
    test::TileRecipe recipe;
    recipe.west = 7 + 0.25 * column, recipe.south = 50.5 + 0.125 * row;
    recipe.heightM = [](double x, double y) { return 300 + 200 * std::sin(x * 80) * std::cos(y * 90); };
    recipe.cells = 10;
    const auto name = std::to_string(3072816 + 10 * row + column) + ".btg";
    meshes.push_back(terrain::parseBtg(test::gridTile(recipe), name).value());
  }
  const terrain::SceneryCatalogue catalogue(std::move(meshes));
  // Wider than what is read together is high.
  HeightGrid grid;
  grid.posts = {6.95, 50.45, 0.0004, 0.0008, 2900, 640};
  // It ends inside the grid in the west, has a hole, and is void beside a tile.
  HeightGrid elevation;
  elevation.posts = {7.1, 50.3, 0.003, 0.002, 500, 400};
  for (std::uint32_t r = 0; r < elevation.posts.rows; ++r)
    for (std::uint32_t c = 0; c < elevation.posts.columns; ++c) {
      const double x = elevation.posts.longitude(c), y = elevation.posts.latitude(r);
      const bool isVoid = std::hypot(x - 7.5, y - 50.8) < 0.04 || std::hypot(x - 7.5, y - 50.55) < 0.03;
      elevation.heights.push_back(isVoid ? std::nanf("")
                                         : static_cast<float>(340 + 90 * std::sin(50 * x + 30 * y)));
    }
  const terrain::SceneryRaster raster(catalogue, grid.posts);
  const std::size_t columns = grid.posts.columns;
  grid.heights.resize(grid.posts.size());
  std::vector<std::uint8_t> reached(grid.posts.size());
  ASSERT_TRUE(raster.read(0, grid.posts.rows, grid.heights));
  for (std::uint32_t row = 0; row < grid.posts.rows; ++row)
    raster.reached(row, std::span(reached).subspan(row * columns, columns));
  const std::vector<float> scenery = grid.heights;
  blendWhole(grid, elevation, reached);
  std::size_t voids = 0, own = 0, blended = 0;
  for (std::size_t i = 0; i < scenery.size(); ++i) {
    voids += std::isnan(grid.heights[i]);
    own += !std::isnan(scenery[i]);
    blended += std::isnan(scenery[i]) && !std::isnan(grid.heights[i]);
  }
  for (const std::size_t count : {voids, own, blended}) ASSERT_GT(count, grid.posts.size() / 50);

  terrain::BlendedRows rows(raster, terrain::sourceOf(elevation));
  std::mt19937 random(9);
  const auto check = [&](std::uint32_t from, std::uint32_t most) {
    std::size_t wrong = 0;
    for (std::uint32_t first = from; first < grid.posts.rows;) {
      const std::uint32_t some =
          std::min(1 + static_cast<std::uint32_t>(random() % most), grid.posts.rows - first);
      std::vector<float> heights(some * columns);
      std::vector<std::uint8_t> reach(some * columns, 7);
      EXPECT_TRUE(rows.read(first, some, heights, reach));
      for (std::size_t i = 0; i < heights.size(); ++i)
        wrong +=
            !same(heights[i], grid.heights[first * columns + i]) || reach[i] != reached[first * columns + i];
      first += some;
    }
    return wrong;
  };
  EXPECT_EQ(check(0, 60), 0U);
  EXPECT_EQ(check(310, 5), 0U) << "from the middle, which takes what is south of it";
  EXPECT_EQ(check(0, 1000), 0U) << "all together";
}

}  // namespace
}  // namespace trimtab
