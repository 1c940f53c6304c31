#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "trimtab/hold/arbiter.h"
#include "trimtab/units/not_finite.h"

namespace trimtab {
namespace {

TEST(ErrorInMotion, isTheRestsErrorUntilTheSmearIsLonger) {
  EXPECT_DOUBLE_EQ(errorInMotion(2, 0, 16, 1100), 2);
  // 180 degrees a second for 16 ms at 1,100 pixels a radian: 55.3 pixels.
  EXPECT_NEAR(errorInMotion(2, 180, 16, 1100), std::sqrt(2 * 55.292), 1e-3);
  EXPECT_DOUBLE_EQ(errorInMotion(2, kNan, 16, 1100), 2);
  EXPECT_DOUBLE_EQ(errorInMotion(2, kInfinity, 16, 1100), 2);
  EXPECT_DOUBLE_EQ(errorInMotion(2, 180, 0, 1100), 2);
}

/// The derivation of errorInMotion, by brute force: a strip of width e changed by 1, averaged over m pixels,
/// has the squared error e * e / m.
TEST(ErrorInMotion, makesTheSquaredErrorUnderTheSmearThatOfRest) {
  for (const double rest : {0.5, 1.0, 2.0, 4.0})
    for (const double smearPx : {8.0, 30.0, 60.0}) {
      const double e = std::sqrt(rest * smearPx);
      constexpr double kStep = 0.01;
      double sum = 0;
      for (double x = -smearPx - e; x < smearPx + e; x += kStep) {
        const double covered = std::min(x + smearPx / 2, e / 2) - std::max(x - smearPx / 2, -e / 2);
        const double change = std::max(covered, 0.0) / smearPx;
        sum += change * change * kStep;
      }
      // Triangular ends make it a little less than e^2 / m.
      EXPECT_LE(sum, rest * 1.01);
      EXPECT_GE(sum, rest * 0.6);
    }
}

}  // namespace
}  // namespace trimtab
