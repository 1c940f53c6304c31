#include "trimtab/terrain/grid/voids.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>

#include "tests/core/terrain/grid/fill_grid.h"

namespace trimtab::terrain {
namespace {

HeightGrid plane(std::uint32_t columns, std::uint32_t rows) {
  HeightGrid grid{{0, 0, 0.001, 0.001, columns, rows}, {}, 0, {}};
  for (std::uint32_t r = 0; r < rows; ++r)
    for (std::uint32_t c = 0; c < columns; ++c)
      grid.heights.push_back(static_cast<float>(100 + 3.0 * c - 2.0 * r));
  return grid;
}
constexpr float kNanF = std::numeric_limits<float>::quiet_NaN();

TEST(FillVoids, leavesGroundWithoutVoidsAlone) {
  HeightGrid grid = plane(40, 30);
  const auto before = grid.heights;
  EXPECT_EQ(test::fillVoids(grid), 0u);
  EXPECT_EQ(grid.heights, before);
}

TEST(FillVoids, continuesASlopeThroughAHole) {
  HeightGrid grid = plane(120, 100);
  const auto whole = grid.heights;
  std::uint64_t made = 0;
  for (std::uint32_t r = 30; r < 62; ++r)
    for (std::uint32_t c = 40; c < 75; ++c) grid.heights[r * 120 + c] = kNanF, ++made;
  EXPECT_EQ(test::fillVoids(grid), made);
  // A plane is its own membrane; the rest of the sweeps may be a few metres of the 135 m across the hole.
  for (std::size_t i = 0; i < whole.size(); ++i) ASSERT_NEAR(grid.heights[i], whole[i], 4) << i;
}

TEST(FillVoids, staysWithinTheHeightsAround) {
  HeightGrid grid = plane(77, 91);
  for (std::size_t i = 0; i < grid.heights.size(); ++i)
    if ((i * 2654435761u >> 7) % 3 != 0 || i % 77 > 50) grid.heights[i] = kNanF;
  float low = 1e9f, high = -1e9f;
  for (const float h : grid.heights)
    if (!std::isnan(h)) low = std::min(low, h), high = std::max(high, h);
  EXPECT_GT(test::fillVoids(grid), 4000u);
  for (const float h : grid.heights) {
    ASSERT_GE(h, low);
    ASSERT_LE(h, high);
  }
}

TEST(FillVoids, makesSeaOfNothing) {
  HeightGrid grid = plane(9, 7);
  std::fill(grid.heights.begin(), grid.heights.end(), kNanF);
  EXPECT_EQ(test::fillVoids(grid), 63u);
  for (const float h : grid.heights) EXPECT_EQ(h, 0);
}

TEST(FillVoids, fillsFromASinglePost) {
  HeightGrid grid = plane(33, 65);
  std::fill(grid.heights.begin(), grid.heights.end(), kNanF);
  grid.heights[700] = 42;
  EXPECT_EQ(test::fillVoids(grid), 33u * 65 - 1);
  for (const float h : grid.heights) ASSERT_NEAR(h, 42, 1e-3);
}

/// The same membrane with the whole of each level in memory: halved, brought down, swept twelve times.
std::vector<float> membrane(std::uint32_t columns, std::uint32_t rows, std::vector<float> heights) {
  const auto empty = [](float h) { return std::isnan(h); };
  if (std::none_of(heights.begin(), heights.end(), empty)) return heights;
  const std::uint32_t across = (columns + 1) / 2, up = (rows + 1) / 2;
  std::vector<float> coarse;
  for (std::uint32_t r = 0; r < up; ++r)
    for (std::uint32_t c = 0; c < across; ++c) {
      float sum = 0, count = 0;
      for (std::uint32_t y = 2 * r; y < std::min(2 * r + 2, rows); ++y)
        for (std::uint32_t x = 2 * c; x < std::min(2 * c + 2, columns); ++x)
          if (const float h = heights[y * columns + x]; !empty(h)) sum += h, count += 1;
      coarse.push_back(count > 0 ? sum / count : kNanF);
    }
  coarse = membrane(across, up, std::move(coarse));
  std::vector<std::uint32_t> voids;
  for (std::uint32_t i = 0; i < heights.size(); ++i)
    if (empty(heights[i])) voids.push_back(i);
  for (const std::uint32_t i : voids) {
    const auto clamped = [](std::uint32_t at, std::uint32_t most) {
      return std::clamp((static_cast<float>(at) - 0.5f) / 2, 0.0f, static_cast<float>(most - 1));
    };
    const float y = clamped(i / columns, up), x = clamped(i % columns, across);
    const auto r = static_cast<std::uint32_t>(y), c = static_cast<std::uint32_t>(x);
    const std::uint32_t r1 = std::min(r + 1, up - 1), c1 = std::min(c + 1, across - 1);
    const float v = y - static_cast<float>(r), u = x - static_cast<float>(c);
    heights[i] = (coarse[r * across + c] * (1 - u) + coarse[r * across + c1] * u) * (1 - v) +
                 (coarse[r1 * across + c] * (1 - u) + coarse[r1 * across + c1] * u) * v;
  }
  for (int sweep = 0; sweep < 12; ++sweep)
    for (const std::uint32_t i : voids) {
      float sum = 0, count = 0;
      if (i >= columns) sum += heights[i - columns], count += 1;
      if (i + columns < heights.size()) sum += heights[i + columns], count += 1;
      if (i % columns > 0) sum += heights[i - 1], count += 1;
      if (i % columns + 1 < columns) sum += heights[i + 1], count += 1;
      heights[i] = sum / count;
    }
  return heights;
}

struct Shape {
  const char* name;
  std::uint32_t columns, rows;
  std::function<bool(double, double)> isVoid;  ///< at 0..1 across, 0..1 up
};
const Shape kShapes[] = {
    {"posts here and there", 97, 131,
     [](double x, double y) { return std::fmod(x * 911 + y * 577, 1) < 0.3; }},
    {"wider than any band", 150, 300, [](double, double y) { return y > 0.1 && y < 0.9; }},
    {"all but a corner", 130, 257, [](double x, double y) { return x > 0.02 || y > 0.02; }},
    {"all but the last post", 64, 200, [](double x, double y) { return x < 0.984 || y < 0.994; }},
    {"columns", 200, 77, [](double x, double) { return std::fmod(x * 10, 1) < 0.5; }},
    {"a ring", 160, 160,
     [](double x, double y) { return std::abs(std::hypot(x - 0.5, y - 0.5) - 0.3) < 0.1; }},
    {"a spiral", 140, 190,
     [](double x, double y) {
       return std::sin(std::atan2(y - 0.5, x - 0.5) + 25 * std::hypot(x - 0.5, y - 0.5)) > 0;
     }},
    {"a slanted edge", 301, 99, [](double x, double y) { return y > 0.3 + 0.5 * x; }},
    {"one row", 1, 70, [](double, double y) { return y > 0.4; }},
    {"one column", 90, 1, [](double x, double) { return x < 0.7; }},
};

TEST(FillVoids, isTheWholeMembraneToTheBitWhateverTheShape) {
  for (const Shape& shape : kShapes) {
    HeightGrid grid = plane(shape.columns, shape.rows);
    std::uint64_t voids = 0;
    for (std::size_t i = 0; i < grid.heights.size(); ++i) {
      grid.heights[i] += static_cast<float>(i * 2654435761u % 97);
      if (shape.isVoid(static_cast<double>(i % shape.columns) / shape.columns,
                       static_cast<double>(i / shape.columns) / shape.rows))
        grid.heights[i] = kNanF, ++voids;
    }
    const std::vector<float> expected = membrane(shape.columns, shape.rows, grid.heights);
    // Through a file of coarse levels as well as through memory.
    std::vector<float> kept = grid.heights;
    VoidFill fill{shape.columns, shape.rows, {}, {}, std::filesystem::temp_directory_path(), 0, {}};
    std::uint32_t written = 0;
    fill.read = [&](std::uint32_t first, std::uint32_t rows, std::span<float> heights) -> Result<Done> {
      EXPECT_EQ(heights.size(), std::size_t{rows} * shape.columns);
      std::copy_n(kept.begin() + first * shape.columns, heights.size(), heights.begin());
      return Done{};
    };
    fill.write = [&](std::uint32_t first, std::uint32_t rows,
                     std::span<const float> heights) -> Result<Done> {
      written += rows;
      std::copy_n(heights.begin(), heights.size(), kept.begin() + first * shape.columns);
      return Done{};
    };
    const auto filled = fillVoids(fill);
    ASSERT_TRUE(filled) << toString(filled.findings());
    EXPECT_EQ(*filled, voids) << shape.name;
    EXPECT_EQ(kept, expected) << shape.name;
    EXPECT_LE(written, shape.rows);
    EXPECT_EQ(test::fillVoids(grid), voids);
    EXPECT_EQ(grid.heights, expected) << shape.name;
  }
}

TEST(FillVoids, saysWhereAFileFailedAndStopsWhenToldTo) {
  VoidFill fill{40, 90, {}, {}, "/nowhere at all", 0, {}};
  fill.read = [](std::uint32_t, std::uint32_t, std::span<float> heights) -> Result<Done> {
    std::fill(heights.begin(), heights.end(), 1.0f);
    heights[5] = kNanF;
    return Done{};
  };
  fill.write = [](std::uint32_t, std::uint32_t, std::span<const float>) -> Result<Done> { return Done{}; };
  const auto nowhere = fillVoids(fill);
  ASSERT_FALSE(nowhere);
  EXPECT_NE(toString(nowhere.findings()).find("/nowhere at all"), std::string::npos);
  fill.scratch = std::filesystem::temp_directory_path();
  ASSERT_TRUE(fillVoids(fill));
  fill.carryOn = [](double share) { return share < 0.5; };
  EXPECT_FALSE(fillVoids(fill));
  fill.carryOn = {};
  fill.write = [](std::uint32_t, std::uint32_t, std::span<const float>) -> Result<Done> {
    return Finding{Severity::error, "disk", "", "room", "none"};
  };
  EXPECT_FALSE(fillVoids(fill));
}

}  // namespace
}  // namespace trimtab::terrain
