#include "trimtab/culling/frustum.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "view_axes.h"

namespace trimtab {
namespace {

/// How many of a box's corners are in the picture, by projecting them.
int cornersInPicture(const Box& b, const EyePose& eye, const ViewShape& v) {
  int inside = 0;
  for (int i = 0; i < 8; ++i) {
    const Vec3 p{i & 1 ? b.maxX : b.minX, i & 2 ? b.maxY : b.minY, i & 4 ? b.maxZ : b.minZ};
    const Vec3 e = eye.axes * (p - eye.position);
    const double depth = -e.z;
    inside += depth >= v.nearM && e.x >= v.left * depth && e.x <= v.right * depth &&
              e.y >= v.bottom * depth && e.y <= v.top * depth;
  }
  return inside;
}

TEST(Frustum, holdsABoxOnlyWhereAllOfItIsInThePicture) {
  std::mt19937 random(17);
  std::uniform_real_distribution<double> unit(0, 1);
  const auto place = [&](double reach) { return static_cast<float>(reach * (2 * unit(random) - 1)); };
  int held = 0, cut = 0;
  for (int view = 0; view < 200; ++view) {
    const double wide = 0.2 + unit(random), high = 0.2 + unit(random);
    const ViewShape shape{
        1280, 720, -wide, wide * (0.5 + unit(random)), -high, high, 0.5 + 20 * unit(random)};
    const EyePose eye{{1e5 * unit(random), -1e5 * unit(random), 3000 * unit(random)},
                      test::axesOf(360 * unit(random), 160 * unit(random) - 80, 360 * unit(random))};
    const Frustum frustum(eye, shape);
    for (int i = 0; i < 200; ++i) {
      const double away = 5000 * unit(random), size = 0.2 * away * unit(random);
      const auto x = static_cast<float>(eye.position.x) + place(away),
                 y = static_cast<float>(eye.position.y) + place(away),
                 z = static_cast<float>(eye.position.z) + place(away);
      const auto side = [&] { return static_cast<float>(size * unit(random)); };
      const Box box{x, y, z, x + side(), y + side(), z + side()};
      const int inside = cornersInPicture(box, eye, shape);
      if (frustum.holds(box)) {
        ++held;
        ASSERT_EQ(inside, 8) << "view " << view << ", box " << i;
        ASSERT_TRUE(frustum.mayShow(box));
      }
      cut += inside == 8 && !frustum.holds(box);
    }
  }
  EXPECT_GT(held, 500);
  EXPECT_LE(cut, held / 100) << "what lies clearly inside is held";
}

TEST(Frustum, holdsNothingThatIsEndlessOrNoNumber) {
  constexpr float kInfinite = std::numeric_limits<float>::infinity(),
                  kNone = std::numeric_limits<float>::quiet_NaN();
  const ViewShape shape;
  const EyePose eye{{0, 0, 0}, test::axesOf(0)};
  const Frustum frustum(eye, shape);
  EXPECT_TRUE(frustum.holds({-1, 1000, -1, 1, 1001, 1}));
  for (const float wrong : {kInfinite, kNone}) {
    EXPECT_FALSE(frustum.holds({-1, 1000, -1, 1, wrong, 1}));
    EXPECT_FALSE(frustum.holds({-wrong, -wrong, -wrong, wrong, wrong, wrong}));
  }
  const double nowhere = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(Frustum({{nowhere, 0, 0}, eye.axes}, shape).holds({-1, 1000, -1, 1, 1001, 1}));
}

}  // namespace
}  // namespace trimtab
