#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "trimtab/culling/box_arrays.h"

namespace trimtab {
namespace {

constexpr std::array kLevels{SimdLevel::portable, SimdLevel::avx2, SimdLevel::avx512};

BoxArrays arraysOf(const std::vector<Box>& boxes) {
  BoxArrays arrays;
  arrays.resize(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) arrays.set(i, boxes[i]);
  return arrays;
}

/// Boxes of each level against Frustum::mayShow, which is in double; how many are kept.
std::size_t compare(const std::vector<Box>& boxes, const EyePose& eye, const ViewShape& view) {
  const BoxArrays arrays = arraysOf(boxes);
  const Frustum frustum(eye, view);
  std::size_t kept = 0, wrong = 0;
  for (const SimdLevel level : kLevels) {
    if (level > simdLevel()) continue;
    const BlockTest test(arrays, frustum, level);
    for (std::size_t i = 0; i < test.blocks() * BoxArrays::kBlock; ++i) {
      const bool shown = (test(i / BoxArrays::kBlock) >> (i % BoxArrays::kBlock) & 1) != 0;
      const bool expected = i < boxes.size() && frustum.mayShow(boxes[i]);
      kept += shown && level == SimdLevel::portable;
      wrong += shown != expected;
    }
  }
  EXPECT_EQ(wrong, 0u);
  return kept;
}

Mat3 anyAxes(std::mt19937& random) {
  std::normal_distribution<double> normal;
  const Vec3 a = normalized({normal(random), normal(random), normal(random)});
  const Vec3 b = normalized(cross(a, {normal(random), normal(random), normal(random)}));
  return {{a, b, cross(a, b)}};
}

std::vector<Box> randomBoxes(std::mt19937& random, std::size_t count, float reach, float size) {
  std::uniform_real_distribution<float> place(-reach, reach), side(0, size);
  std::vector<Box> boxes;
  for (std::size_t i = 0; i < count; ++i) {
    const float x = place(random), y = place(random), z = place(random);
    boxes.push_back({x, y, z, x + side(random), y + side(random), z + side(random)});
  }
  return boxes;
}

TEST(BlockTest, keepsExactlyWhatTheExactTestKeepsAtEveryLevel) {
  std::mt19937 random(1);
  std::size_t kept = 0;
  for (const float reach : {1e-2f, 1e3f, 1e5f, 1e7f})
    for (int view = 0; view < 40; ++view) {
      std::uniform_real_distribution<double> place(-double{reach}, double{reach});
      kept += compare(randomBoxes(random, 1000 + static_cast<std::size_t>(view), reach, reach / 20),
                      {{place(random), place(random), place(random)}, anyAxes(random)}, {});
    }
  EXPECT_GT(kept, 5000u);
}

// Single precision alone cannot tell these, and the margin is where the answer turns.
TEST(BlockTest, agreesOnBoxesThatTouchAPlane) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int view = 0; view < 60; ++view) {
    const EyePose eye{{30000 * unit(random), 20000 * unit(random), 2000 * unit(random)}, anyAxes(random)};
    const ViewShape shape;
    const Frustum frustum(eye, shape);
    std::vector<Box> boxes;
    for (const auto& plane : frustum.planes())
      for (int i = 0; i < 300; ++i) {
        // A point on the plane, then off it by no more than what rounding in floats may do.
        Vec3 p =
            eye.position + Vec3{unit(random), unit(random), unit(random)} * (i % 2 == 0 ? 40000.0 : 40.0);
        p = p - plane.normal * (dot(plane.normal, p - eye.position) - plane.offset -
                                (i % 3 == 0 ? 0.2 : 0.02) * (unit(random) - 0.5));
        const float x = static_cast<float>(p.x), y = static_cast<float>(p.y), z = static_cast<float>(p.z);
        boxes.push_back({x, y, z, x, y, z});
        boxes.push_back({x - 500, y - 500, z - 50, x, y, z});
      }
    compare(boxes, eye, shape);
  }
}

TEST(BlockTest, dropsNothingThatIsInfiniteOrNoNumberUnlessTheExactTestDoes) {
  constexpr float kInf32 = std::numeric_limits<float>::infinity(),
                  kNan32 = std::numeric_limits<float>::quiet_NaN();
  std::mt19937 random(3);
  for (int view = 0; view < 20; ++view) {
    std::vector<Box> boxes = randomBoxes(random, 130, 1e4f, 500);
    boxes[7] = {-kInf32, -kInf32, -kInf32, kInf32, kInf32, kInf32};
    boxes[70] = {0, 0, 0, kInf32, 10, 10};
    boxes[129] = {kNan32, 0, 0, 1, 1, 1};
    const EyePose eye{{0, 0, 100}, anyAxes(random)};
    compare(boxes, eye, {});
    const BoxArrays arrays = arraysOf(boxes);
    const Frustum frustum(eye, {});
    const BlockTest test(arrays, frustum);
    EXPECT_TRUE(test(0) >> 7 & 1) << "everywhere is in every view";
    EXPECT_TRUE(test(2) >> 1 & 1) << "a box of no place is drawn";
  }
}

TEST(BlockTest, dropsNothingForAnEyeThatIsNotANumberOrAViewOfNoWidth) {
  std::mt19937 random(4);
  const std::vector<Box> boxes = randomBoxes(random, 200, 1e4f, 500);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(compare(boxes, {{nan, 0, 0}, anyAxes(random)}, {}), boxes.size());
  EXPECT_EQ(
      compare(boxes, {{0, 0, 0}, Mat3{{Vec3{nan, nan, nan}, Vec3{nan, nan, nan}, Vec3{nan, nan, nan}}}}, {}),
      boxes.size());
  ViewShape closed;
  closed.left = closed.right = 0;
  compare(boxes, {{0, 0, 0}, anyAxes(random)}, closed);
}

TEST(BlockTest, hasNoBitPastTheLastBox) {
  std::mt19937 random(5);
  for (const std::size_t count : {0u, 1u, 63u, 64u, 65u, 640u}) {
    const BoxArrays arrays = arraysOf(randomBoxes(random, count, 1, 1e6f));
    EXPECT_EQ(arrays.size(), count);
    const Frustum frustum({{0, 0, 0}, anyAxes(random)}, {});
    const BlockTest test(arrays, frustum);
    EXPECT_EQ(test.blocks(), (count + 63) / 64);
    if (count % 64 != 0) {
      EXPECT_EQ(test(test.blocks() - 1) >> (count % 64), 0u);
    }
  }
}

}  // namespace
}  // namespace trimtab
