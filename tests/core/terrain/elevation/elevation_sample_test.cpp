#include "core/terrain/elevation/sample.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "trimtab/units/not_finite.h"

namespace trimtab::terrain {
namespace {

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

TEST_F(ElevationSample, isAMeanAlongOneAxisAndAHeightBetweenAlongTheOther) {
  // A plane: 3 a column, 10 a row.
  for (std::size_t i = 0; i < 30; ++i) posts_[i] = static_cast<float>(3 * (i % 6) + 10 * (i / 6));
  for (const double other : {-0.5, 0.0, 0.3, 1.0, 2.75, 4.0, 4.5}) {
    EXPECT_FLOAT_EQ(meanAlong(window_, true, 6, 5, 2.2, other, 3), static_cast<float>(6 + 10 * other));
    EXPECT_FLOAT_EQ(meanAlong(window_, false, 6, 5, other, 2.2, 3), static_cast<float>(20 + 3 * other));
  }
  posts_[2 * 6 + 2] = posts_[2 * 6 + 3] = static_cast<float>(kNone);
  EXPECT_TRUE(std::isnan(meanAlong(window_, true, 6, 5, 2.2, 1.5, 3))) << "most of a row that counts";
  EXPECT_FALSE(std::isnan(meanAlong(window_, true, 6, 5, 2.2, 0.5, 3))) << "one of the outer rows";
  for (const double away : kFarAway) EXPECT_TRUE(std::isnan(meanAlong(window_, true, 6, 5, 2, away, 3)));
  for (const double away : {-1e19, 1e19, kInfinity, kNone})
    EXPECT_TRUE(std::isnan(meanAlong(window_, true, 6, 5, away, 2, 3)));
}

TEST_F(ElevationSample, isTheMeanOfAllWhereTheFootprintIsHuge) {
  for (const double size : {11.0, 1e19, 1e300, kInfinity})
    EXPECT_EQ(meanAbout(window_, 2, 2, size, size), 70);
}

TEST(ElevationCliff, castsNoTrenchIntoTheSeaAndNoCrestOverTheLand) {
  // Sea in the west, a cliff of 160 m, and a plateau that rises a little.
  constexpr std::int64_t kSide = 8;
  std::vector<float> heights;
  for (int r = 0; r < kSide; ++r)
    for (int c = 0; c < kSide; ++c) heights.push_back(c < 4 ? 0.0f : 160.0f + static_cast<float>(c));
  const RasterWindow window{0, 0, kSide, kSide, heights};
  for (double x = 2; x <= 5; x += 0.05)
    for (const double y : {2.0, 3.3}) {
      const float between = heightBetween(window, kSide, kSide, x, y),
                  along = meanAlong(window, false, kSide, kSide, x, y, 3);
      for (const float height : {between, along}) {
        EXPECT_GE(height, 0) << x;
        EXPECT_LE(height, 167) << x;
      }
    }
  // Between the last posts of the sea there is sea.
  EXPECT_EQ(heightBetween(window, kSide, kSide, 2.7, 3.3), 0);
  // Beyond the border the slope goes on.
  EXPECT_NEAR(heightBetween(window, kSide, kSide, 7.5, 3.3), 167.5, 1e-4);
}

}  // namespace
}  // namespace trimtab::terrain
