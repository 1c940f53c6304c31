#include "trimtab/terrain/voids.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace trimtab::terrain {
namespace {

HeightGrid plane(std::uint32_t columns, std::uint32_t rows) {
  HeightGrid grid{{0, 0, 0.001, 0.001, columns, rows}, {}, 0, {}};
  for (std::uint32_t r = 0; r < rows; ++r)
    for (std::uint32_t c = 0; c < columns; ++c)
      grid.heights.push_back(static_cast<float>(100 + 3.0 * c - 2.0 * r));
  return grid;
}
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

TEST(FillVoids, leavesGroundWithoutVoidsAlone) {
  HeightGrid grid = plane(40, 30);
  const auto before = grid.heights;
  EXPECT_EQ(fillVoids(grid), 0u);
  EXPECT_EQ(grid.heights, before);
}

TEST(FillVoids, continuesASlopeThroughAHole) {
  HeightGrid grid = plane(120, 100);
  const auto whole = grid.heights;
  std::uint64_t made = 0;
  for (std::uint32_t r = 30; r < 62; ++r)
    for (std::uint32_t c = 40; c < 75; ++c) grid.heights[r * 120 + c] = kNaN, ++made;
  EXPECT_EQ(fillVoids(grid), made);
  // A plane is its own membrane; the rest of the sweeps may be a few metres of the 135 m across the hole.
  for (std::size_t i = 0; i < whole.size(); ++i) ASSERT_NEAR(grid.heights[i], whole[i], 4) << i;
}

TEST(FillVoids, staysWithinTheHeightsAround) {
  HeightGrid grid = plane(77, 91);
  for (std::size_t i = 0; i < grid.heights.size(); ++i)
    if ((i * 2654435761u >> 7) % 3 != 0 || i % 77 > 50) grid.heights[i] = kNaN;
  float low = 1e9f, high = -1e9f;
  for (const float h : grid.heights)
    if (!std::isnan(h)) low = std::min(low, h), high = std::max(high, h);
  EXPECT_GT(fillVoids(grid), 4000u);
  for (const float h : grid.heights) {
    ASSERT_GE(h, low);
    ASSERT_LE(h, high);
  }
}

TEST(FillVoids, makesSeaOfNothing) {
  HeightGrid grid = plane(9, 7);
  std::fill(grid.heights.begin(), grid.heights.end(), kNaN);
  EXPECT_EQ(fillVoids(grid), 63u);
  for (const float h : grid.heights) EXPECT_EQ(h, 0);
}

TEST(FillVoids, fillsFromASinglePost) {
  HeightGrid grid = plane(33, 65);
  std::fill(grid.heights.begin(), grid.heights.end(), kNaN);
  grid.heights[700] = 42;
  EXPECT_EQ(fillVoids(grid), 33u * 65 - 1);
  for (const float h : grid.heights) ASSERT_NEAR(h, 42, 1e-3);
}

}  // namespace
}  // namespace trimtab::terrain
