#include <algorithm>
#include <cmath>

#include "tests/core/terrain/elevation/rasters.h"
#include "tests/core/terrain/elevation/read_elevation.h"
#include "trimtab/terrain/synthetic/sample.h"

namespace trimtab::terrain {
namespace {

class Sample : public ::testing::Test {
 protected:
  HeightGrid make(const SampleOptions& options) {
    const auto done = writeSample(dir_ / "sample.tif", options);
    EXPECT_TRUE(done) << toString(done.findings());
    auto grid = test::readElevation(dir_ / "sample.tif");
    EXPECT_TRUE(grid) << toString(grid.findings());
    return grid ? std::move(grid).value() : HeightGrid{};
  }
  test::ScratchDir dir_;
};

/// 100 km at 240 m: the shape of the default at a sixteenth of its posts.
SampleOptions small(std::uint32_t seed) {
  SampleOptions options;
  options.seed = seed;
  options.postM = 240;
  return options;
}

TEST_F(Sample, isTheSameForASeedAndAnotherForAnother) {
  SampleOptions options;
  options.postM = 700;
  options.seed = 7;
  make(options);
  EXPECT_EQ(test::namesIn(dir_.path()), std::vector<std::string>{"sample.tif"});
  const std::string first = test::readFile(dir_ / "sample.tif");
  make(options);
  EXPECT_EQ(test::readFile(dir_ / "sample.tif"), first);
  options.seed = 8;
  make(options);
  EXPECT_NE(test::readFile(dir_ / "sample.tif"), first);
}

TEST_F(Sample, isAHundredKilometresAroundItsMiddle) {
  const HeightGrid grid = make(small(1));
  const PostGrid& posts = grid.posts;
  EXPECT_NEAR(posts.longitude((posts.columns - 1) / 2.0), 128.35, 1e-6);
  EXPECT_NEAR(posts.latitude((posts.rows - 1) / 2.0), 36.63, 1e-6);
  // A degree of latitude is 110.97 km there, of longitude 89.45 km.
  EXPECT_NEAR((posts.columns - 1) * posts.stepLongitude * 89.45, 100, 0.5);
  EXPECT_NEAR((posts.rows - 1) * posts.stepLatitude * 110.97, 100, 0.5);
}

TEST_F(Sample, hasPeaksAValleyFloorForAnAirfieldAndTheSea) {
  for (const std::uint32_t seed : {1u, 12345u}) {
    const HeightGrid grid = make(small(seed));
    const auto [low, high] = std::minmax_element(grid.heights.begin(), grid.heights.end());
    EXPECT_EQ(*low, 0) << seed;
    EXPECT_NEAR(*high, 1500, 150) << seed;
    const double sea = static_cast<double>(std::count(grid.heights.begin(), grid.heights.end(), 0.0f)) /
                       static_cast<double>(grid.heights.size());
    EXPECT_GT(sea, 0.02) << seed;
    EXPECT_LT(sea, 0.4) << seed;
    const std::uint32_t middle = grid.posts.columns / 2;
    for (std::uint32_t r = middle - 10; r <= middle + 10; ++r)
      for (std::uint32_t c = middle - 10; c <= middle + 10; ++c)
        if (std::hypot(static_cast<double>(r) - middle, static_cast<double>(c) - middle) * 240 < 2300) {
          ASSERT_NEAR(grid.heights[r * grid.posts.columns + c], 108, 0.02) << seed;
        }
  }
}

TEST_F(Sample, drainsToTheSeaFromEverywhere) {
  SampleOptions options;
  options.postM = 400;
  const HeightGrid grid = make(options);
  const auto side = static_cast<int>(grid.posts.columns);
  const auto height = [&](int r, int c) { return grid.heights[static_cast<std::size_t>(r * side + c)]; };
  // Water spreads uphill from the sea: what it does not reach lies in a hollow.
  std::vector<std::uint8_t> wet(grid.heights.size(), 0);
  std::vector<int> todo;
  std::size_t land = 0, reached = 0;
  for (int i = 0; i < side * side; ++i) {
    if (grid.heights[static_cast<std::size_t>(i)] <= 0)
      todo.push_back(i), wet[static_cast<std::size_t>(i)] = 1;
    else
      ++land;
  }
  while (!todo.empty()) {
    const int i = todo.back();
    todo.pop_back();
    for (int r = std::max(0, i / side - 1); r <= std::min(side - 1, i / side + 1); ++r)
      for (int c = std::max(0, i % side - 1); c <= std::min(side - 1, i % side + 1); ++c) {
        std::uint8_t& there = wet[static_cast<std::size_t>(r * side + c)];
        // The file's steps of 1/64 m make a slow river flat here and there.
        if (there || height(r, c) < height(i / side, i % side)) continue;
        there = 1;
        ++reached;
        todo.push_back(r * side + c);
      }
  }
  EXPECT_GT(static_cast<double>(reached), 0.999 * static_cast<double>(land));
}

TEST_F(Sample, leavesNothingWhenCancelledAndRefusesNonsense) {
  SampleOptions options = small(1);
  for (const double stop : {0.0, 0.3, 0.93}) {
    options.progress = [&](double f, const std::string&) { return f < stop; };
    EXPECT_FALSE(writeSample(dir_ / "sample.tif", options));
    EXPECT_TRUE(test::namesIn(dir_.path()).empty());
  }
  for (const auto& [size, post] : {std::pair{0.0, 60.0},
                                   {100.0, 0.0},
                                   {100.0, -5.0},
                                   {std::nan(""), 60.0},
                                   {100.0, std::nan("")},
                                   {1e9, 60.0},
                                   {1000.0, 5.0}}) {
    SampleOptions bad;
    bad.sizeKm = size;
    bad.postM = post;
    EXPECT_FALSE(writeSample(dir_ / "sample.tif", bad)) << size << " " << post;
  }
  SampleOptions bad;
  bad.postM = 5;
  EXPECT_EQ(writeSample(dir_ / "sample.tif", bad).findings()[0].found, "20001");
  bad.sizeKm = 4.5;
  EXPECT_EQ(writeSample(dir_ / "sample.tif", bad).findings()[0].found, "4.5 km");
  const auto nowhere = writeSample("/nonexistent/sample.tif", small(1));
  ASSERT_FALSE(nowhere);
  EXPECT_NE(toString(nowhere.findings()).find("/nonexistent/sample.tif"), std::string::npos);
}

}  // namespace
}  // namespace trimtab::terrain
