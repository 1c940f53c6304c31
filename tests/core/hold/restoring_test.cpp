#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "arbiter_input.h"

namespace trimtab {
namespace {

using test::enabled;
using test::given;

TEST(Arbiter, lowersAtOnceAndRestoresAfterCalm) {
  HoldMemory memory;
  const HoldParameters p = enabled();
  double time = 0;
  arbitrate(given(time), p, memory);
  HoldGiven heavy = given(time += 0.016);
  heavy.cost.perGroundMpx = 200;
  EXPECT_EQ(arbitrate(heavy, p, memory).reason, HoldReason::lowered);
  int images = 0;
  HoldDecision d;
  do {
    d = arbitrate(given(time += 0.016), p, memory);
    ++images;
  } while (d.held != d.asked && images < 100);
  EXPECT_NEAR(images * 16, p.calm.value(), 16);
}

TEST(Arbiter, theErrorReturnsOnceItsMeshesAreThereOrAfterTwoSeconds) {
  for (const double builtS : {0.5, 10.0}) {
    HoldMemory memory;
    HoldGiven g = given();
    g.budgetMs = 20;
    HoldDecision d = arbitrate(g, enabled(), memory);
    ASSERT_GT(d.held.errorPx, d.asked.errorPx);
    while (d.held.errorPx > d.asked.errorPx && g.timeS < 20) {
      g = given(g.timeS + 0.016);
      g.meshesLeft = g.timeS < builtS ? 1 : 0;
      d = arbitrate(g, enabled(), memory);
    }
    EXPECT_NEAR(g.timeS, std::min(builtS, 2.0), 0.04);
    EXPECT_EQ(d.held.renderScale, 1) << "it did not wait";
  }
}

TEST(Arbiter, aFinerCutThatIsQuickerWaitsForItsMeshesToo) {
  HoldMemory memory;
  HoldGiven g = given();
  g.budgetMs = 30;
  HoldDecision d = arbitrate(g, enabled(), memory);
  ASSERT_GT(d.held.errorPx, d.asked.errorPx);
  // A sliver of ground, into which coarse nodes reach and fine ones do not.
  std::reverse(g.triangles.begin(), g.triangles.end());
  for (double& triangles : g.triangles) triangles *= 12;
  g.groundMpx = 0.1;
  g.meshesLeft = 1;
  const double coarse = d.held.errorPx;
  for (int i = 0; i < 20; ++i) {
    g.timeS += 0.016;
    EXPECT_EQ(arbitrate(g, enabled(), memory).held.errorPx, coarse) << i;
  }
  g.timeS += 0.016;
  g.meshesLeft = 0;
  EXPECT_LT(arbitrate(g, enabled(), memory).held.errorPx, coarse);
}

TEST(Arbiter, waitsForMeshesByTheClockWhateverTheCalmAndTheRate) {
  for (const double calmMs : {0.0, 10.0, 120.0})
    for (const double imageS : {0.004, 0.07}) {
      HoldParameters p = enabled();
      p.calm = Milliseconds{calmMs};
      HoldMemory memory;
      HoldGiven g = given();
      g.budgetMs = 20;
      HoldDecision d = arbitrate(g, p, memory);
      while (d.held.errorPx > d.asked.errorPx && g.timeS < 20) {
        g = given(g.timeS + imageS);
        g.meshesLeft = 1;
        d = arbitrate(g, p, memory);
      }
      EXPECT_NEAR(g.timeS, 2, 2 * imageS + 1e-9) << calmMs;
    }
}

TEST(Arbiter, restoresWithoutAnyImageOverTheLimit) {
  HoldMemory memory;
  const HoldParameters p = enabled();
  double time = 0;
  for (int i = 0; i < 400; ++i) {
    HoldGiven g = given(time += 0.016);
    g.budgetMs = 36;
    g.cost.perGroundMpx = i % 100 < 30 ? 120 : 36;
    const HoldDecision d = arbitrate(g, p, memory);
    if (d.reason != HoldReason::out_of_reach) {
      EXPECT_LE(d.heldMs.total(), d.limitMs + 1e-9) << i;
    }
  }
}

/// A machine that is now quicker and now slower by nearly twice the reserve: without it the levers would go
/// back and forth for as long as the view rests.
TEST(Arbiter, restsWhereTheMachineVaries) {
  HoldMemory memory;
  int changes = 0;
  HeldLevers last;
  for (int i = 0; i < 60 * 60; ++i) {
    HoldGiven g = given(i / 60.0);
    g.budgetMs = 33;
    g.cost.perTriangle *= i % 40 < 20 ? 1.15 : 1;
    g.cost.perGroundMpx *= i % 40 < 20 ? 1.15 : 1;
    const HoldDecision d = arbitrate(g, enabled(), memory);
    changes += i > 0 && d.held != last;
    last = d.held;
  }
  EXPECT_LE(changes, 2) << "90 a minute each way without a reserve";
  // Ample room restores as soon as ever.
  double returnedMs = 0;
  for (int i = 0; i < 120 && returnedMs == 0; ++i) {
    HoldGiven g = given(60 + i / 60.0);
    g.budgetMs = 200;
    if (arbitrate(g, enabled(), memory).held.errorPx == 1) returnedMs = i * 1000 / 60.0;
  }
  EXPECT_GT(returnedMs, 0);
  EXPECT_LE(returnedMs, 2 * enabled().calm.value());
}

/// A calm of nothing, or of less than an image, must not keep the error from returning while the eye moves.
TEST(Arbiter, theErrorReturnsWithAnyCalm) {
  for (const double calmMs : {0.0, 10.0, 120.0, 300.0}) {
    HoldMemory memory;
    double returnedMs = 0;
    for (int i = 0; i < 400 && returnedMs == 0; ++i) {
      HoldGiven g = given(i / 60.0);
      g.budgetMs = 44;
      for (double& triangles : g.triangles) triangles *= i < 50 ? 8 : 1;
      HoldParameters p = enabled();
      p.renderScaleMinimum = Ratio{1};
      p.calm = Milliseconds{calmMs};
      if (arbitrate(g, p, memory).held.errorPx == 1 && i > 50) returnedMs = (i - 50) * 1000 / 60.0;
    }
    EXPECT_NEAR(returnedMs, calmMs, 40);
  }
}

}  // namespace
}  // namespace trimtab
