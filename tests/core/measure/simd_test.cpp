#include "core/measure/simd.h"

#include <gtest/gtest.h>

#include <cmath>

namespace trimtab {
namespace {

// Of the vectors that this file is compiled for; that the wider ones agree is FLIP's test.

TEST(Simd, cubeRootKeepsItsBound) {
  for (float x = 1e-30f; x < 1e30f; x *= 1.0003f)
    ASSERT_NEAR(cubeRoot(x).a[0] / std::cbrt(static_cast<double>(x)), 1, 5e-7) << x;
}

TEST(Simd, logarithmKeepsItsBound) {
  for (float x = 1.2e-38f; x < 3e38f; x *= 1.0003f) {
    const double expected = std::log2(static_cast<double>(x));
    ASSERT_NEAR(log2Of(x).b[kLanes - 1], expected, 3e-7 + std::abs(expected) * 0x1p-24) << x;
  }
}

TEST(Simd, powerKeepsItsBound) {
  for (float x = -126; x < 126; x += 0.0007f)
    ASSERT_NEAR(exp2Of(x).a[1] / std::exp2(static_cast<double>(x)), 1, 3e-7) << x;
}

TEST(Simd, reciprocalKeepsItsBound) {
  for (float x = 1e-30f; x < 1e30f; x *= 1.001f)
    ASSERT_NEAR(static_cast<double>(reciprocal(all(x))[0]) * x, 1, 3e-7) << x;
}

}  // namespace
}  // namespace trimtab
