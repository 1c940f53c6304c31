#include "trimtab/terrain/elevation_sample.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace trimtab::terrain {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
/// Beyond the raster of 6 x 5 posts by more than one, beyond what integers hold, and no numbers at all.
constexpr double kFarAway[] = {-1.001, 6.001, -1e19, 1e19, -1e300, 1e300, -kInfinity, kInfinity, kNone};

class ElevationSample : public ::testing::Test {
 protected:
  /// Level, as there any four posts agree.
  std::vector<float> posts_ = std::vector<float>(30, 70.0f);
  RasterWindow window_{0, 0, 6, 5, posts_};
};

TEST_F(ElevationSample, hasNoHeightFurtherThanAPostFromTheRaster) {
  for (const double away : kFarAway) {
    SCOPED_TRACE(away);
    EXPECT_TRUE(std::isnan(heightBetween(window_, 6, 5, away, 2)));
    EXPECT_TRUE(std::isnan(heightBetween(window_, 6, 5, 2, away)));
    EXPECT_TRUE(std::isnan(heightBetween(window_, 6, 5, away, away)));
  }
  for (const double near : {-1.0, -0.4, 0.0, 4.99, 5.0}) {
    EXPECT_EQ(heightBetween(window_, 6, 5, near, 2.5), 70);
    EXPECT_EQ(heightBetween(window_, 6, 5, 2.5, near), 70);
  }
  EXPECT_EQ(heightBetween(window_, 6, 5, 6, 5), 70);
}

TEST_F(ElevationSample, ofOneRowOrColumnHasTheHeightsOfItsPostsAlone) {
  const RasterWindow row{0, 0, 6, 1, std::span(posts_).first(6)},
      column{0, 0, 1, 5, std::span(posts_).first(5)};
  EXPECT_EQ(heightBetween(row, 6, 1, 3, 0), 70);
  EXPECT_EQ(heightBetween(column, 1, 5, 0, 3), 70);
  for (const double off : {-1.0, -0.5, 0.5, 1.0}) {
    EXPECT_TRUE(std::isnan(heightBetween(row, 6, 1, 3, off)));
    EXPECT_TRUE(std::isnan(heightBetween(column, 1, 5, off, 3)));
  }
}

TEST_F(ElevationSample, hasNoMeanWhereNoPostIs) {
  for (const double away : {-1e19, 1e19, -1e300, 1e300, -kInfinity, kInfinity, kNone}) {
    SCOPED_TRACE(away);
    EXPECT_TRUE(std::isnan(meanAbout(window_, away, 2, 3, 3)));
    EXPECT_TRUE(std::isnan(meanAbout(window_, 2, away, 3, 3)));
  }
  EXPECT_TRUE(std::isnan(meanAbout(window_, 2, 2, kNone, 3)));
  EXPECT_TRUE(std::isnan(meanAbout(window_, 2, 2, 3, -1e300)));
}

TEST_F(ElevationSample, isTheMeanOfAllWhereTheFootprintIsHuge) {
  for (const double size : {11.0, 1e19, 1e300, kInfinity})
    EXPECT_EQ(meanAbout(window_, 2, 2, size, size), 70);
}

}  // namespace
}  // namespace trimtab::terrain
