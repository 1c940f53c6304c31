#include "trimtab/culling/depth_pyramid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "view_axes.h"

namespace trimtab {
namespace {

constexpr float kNanF = std::numeric_limits<float>::quiet_NaN();

Box boxAt(double x, double y, double z, double half) {
  const auto f = [](double v) { return static_cast<float>(v); };
  return {f(x - half), f(y - half), f(z - half), f(x + half), f(y + half), f(z + half)};
}

class DepthPyramidOf : public testing::TestWithParam<std::pair<int, int>> {};

// Brute force: a point of the box is in the picture and its pixel's texel is not nearer.
TEST_P(DepthPyramidOf, hidesNoBoxWithAPointThatCouldBeSeen) {
  const auto [width, height] = GetParam();
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  ViewShape view;
  view.widthPx = 640, view.heightPx = 360;
  const EyePose eye{{}, test::axesOf(0)};
  std::size_t hidden = 0, kept = 0;
  DepthPyramid pyramid;
  for (int map = 0; map < 12; ++map) {
    // A wall with a rough upper edge, and holes.
    std::vector<float> depths(static_cast<std::size_t>(width * height));
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        depths[static_cast<std::size_t>(y * width + x)] =
            y > height * (0.6 + 0.2 * std::sin(x * 40.0 / width + map)) || unit(random) < 0.0005
                ? 0.0f
                : static_cast<float>(1 / (900 + 200 * unit(random)));
    pyramid.build(depths, width, height, width, height);
    for (int i = 0; i < 4000; ++i) {
      const double y = 600 + 4000 * unit(random);
      const Box b = boxAt(y * (1.3 * unit(random) - 0.65), y, y * (0.7 * unit(random) - 0.35),
                          1 + 150 * unit(random) * unit(random));
      if (!pyramid.isHidden(b, eye, view)) {
        ++kept;
        continue;
      }
      ++hidden;
      for (int k = 0; k < 30; ++k) {
        const auto within = [&](float low, float high) {
          return k < 8 ? (random() & 1u ? low : high) : low + (high - low) * unit(random);
        };
        const double px = within(b.minX, b.maxX), py = within(b.minY, b.maxY), pz = within(b.minZ, b.maxZ);
        const double sx = (px / py - view.left) / (view.right - view.left),
                     sy = (pz / py - view.bottom) / (view.top - view.bottom);
        if (sx < 0 || sx >= 1 || sy < 0 || sy >= 1) continue;
        const auto at =
            static_cast<std::size_t>(static_cast<int>(sy * height) * width + static_cast<int>(sx * width));
        ASSERT_LT(1 / py, double{depths[at]});
      }
    }
  }
  EXPECT_GT(hidden, 2000u) << "nothing was hidden, so nothing was tested";
  EXPECT_GT(kept, 2000u);
}

INSTANTIATE_TEST_SUITE_P(Sizes, DepthPyramidOf,
                         testing::Values(std::pair{320, 240}, std::pair{800, 600}, std::pair{33, 77},
                                         std::pair{5, 3}));

class DepthPyramidTest : public testing::Test {
 protected:
  /// Everything at 1,000 m.
  DepthPyramidTest() { pyramid.build(depths, 64, 48, 64, 48); }
  std::vector<float> depths = std::vector<float>(64 * 48, 1 / 1000.0f);
  ViewShape view;
  EyePose eye{{}, test::axesOf(0)};
  DepthPyramid pyramid;
};

TEST_F(DepthPyramidTest, hidesWhatIsBehindAndKeepsWhatIsNot) {
  EXPECT_TRUE(pyramid.isHidden(boxAt(0, 1200, 0, 100), eye, view));
  EXPECT_FALSE(pyramid.isHidden(boxAt(0, 1050, 0, 100), eye, view)) << "it reaches in front";
  EXPECT_FALSE(pyramid.isHidden(boxAt(0, 900, 0, 10), eye, view));
  EXPECT_TRUE(pyramid.isHidden(boxAt(0, 5000, 0, 4000 - 1), eye, view)) << "larger than the picture";
  EXPECT_FALSE(pyramid.isHidden(boxAt(0, 0, 0, 100), eye, view)) << "the eye is in it";
  EXPECT_FALSE(pyramid.isHidden(boxAt(0, -1200, 0, 100), eye, view)) << "behind the eye";
}

TEST_F(DepthPyramidTest, takesTheFarthestPixelThatATexelTouches) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(0.001f, 1);
  for (const auto& [width, height] : {std::pair{64, 48}, std::pair{17, 99}, std::pair{300, 200}}) {
    constexpr int kWide = 101, kHigh = 67;
    std::vector<float> picture(std::size_t{kWide} * kHigh);
    for (float& depth : picture) depth = unit(random);
    pyramid.build(picture, kWide, kHigh, width, height);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        float farthest = 1;
        for (int py = 0; py < kHigh; ++py)
          for (int px = 0; px < kWide; ++px)
            // Open intervals [p, p + 1) and [t, t + 1), in units of one over picture times map.
            if (px * width < (x + 1) * kWide && (px + 1) * width > x * kWide &&
                py * height < (y + 1) * kHigh && (py + 1) * height > y * kHigh)
              farthest = std::min(farthest, picture[static_cast<std::size_t>(py * kWide + px)]);
        ASSERT_EQ(pyramid.depths()[static_cast<std::size_t>(y * width + x)], farthest) << x << ", " << y;
      }
  }
}

TEST_F(DepthPyramidTest, seesThroughASingleHole) {
  depths[24 * 64 + 32] = 0;
  pyramid.build(depths, 64, 48, 64, 48);
  EXPECT_FALSE(pyramid.isHidden(boxAt(0, 5000, 0, 2000), eye, view));
  EXPECT_TRUE(pyramid.isHidden(boxAt(-1500, 5000, 0, 100), eye, view));
}

TEST_F(DepthPyramidTest, hidesNothingByWhatIsNotANumber) {
  const Box behind = boxAt(0, 1200, 0, 100);
  eye.position.x = double{kNanF};
  EXPECT_FALSE(pyramid.isHidden(behind, eye, view));
  eye = {{}, test::axesOf(0)};
  std::fill(depths.begin(), depths.end(), kNanF);
  pyramid.build(depths, 64, 48, 64, 48);
  EXPECT_FALSE(pyramid.isHidden(behind, eye, view));
  EXPECT_FALSE(DepthPyramid{}.isHidden(behind, eye, view)) << "no map";
}

}  // namespace
}  // namespace trimtab
