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
  EXPECT_GE(images * 16, 150);
  EXPECT_LE(images * 16, 250 + 16 * 11);  // render scale comes back a step an image
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

/// A machine that is now quicker and now slower, by more than the arbiter's reserve: without patience the
/// levers would go back and forth for as long as the view rests.
TEST(Arbiter, restoresLessOftenWhereRestoringHadToBeTakenBack) {
  HoldMemory memory;
  int changes = 0, early = 0;
  HeldLevers last;
  for (int i = 0; i < 60 * 60; ++i) {
    HoldGiven g = given(i / 60.0);
    g.budgetMs = 33;
    g.cost.perTriangle *= i % 40 < 20 ? 1.15 : 1;
    g.cost.perGroundMpx *= i % 40 < 20 ? 1.15 : 1;
    const HoldDecision d = arbitrate(g, enabled(), memory);
    changes += i > 0 && d.held != last;
    if (i == 60 * 10) early = changes;
    last = d.held;
  }
  EXPECT_GT(changes, 2) << "at first it tries";
  EXPECT_LE(changes, 16);
  EXPECT_EQ(changes - early, 0) << "head-room that never lasts is left alone";
  // Once there is ample room, restoring waits no longer than at first.
  double returnedMs = 0;
  for (int i = 0; i < 120 && returnedMs == 0; ++i) {
    HoldGiven g = given(60 + i / 60.0);
    g.budgetMs = 200;
    if (arbitrate(g, enabled(), memory).held.errorPx == 1) returnedMs = i * 1000 / 60.0;
  }
  EXPECT_GT(returnedMs, 0);
  EXPECT_LE(returnedMs, 2 * enabled().calm.value());
}

/// The pixels' cost was not seen for long, so a larger image may take much longer than it is predicted to.
TEST(Arbiter, restoresOnlyWhereTheModelIsSure) {
  struct Case {
    double deviation;  ///< of perGroundMpx, ms a million pixels
    double caution;
    bool restores;
  };
  for (const Case& c :
       {Case{0, 1.41, true}, Case{30, 1.41, false}, Case{30, 0, true}, Case{0.5, 1.41, true}}) {
    HoldMemory memory;
    HoldParameters p = enabled();
    p.caution = Ratio{c.caution};
    p.lossError = p.lossParticles = p.lossBlur = Ratio{1};
    HoldDecision d;
    for (int i = 0; i < 120; ++i) {
      HoldGiven g = given(i / 60.0);
      g.budgetMs = i < 30 ? 30 : 46;
      g.cost.bandMs = 0.1;
      g.cost.variance.ground[9] = c.deviation * c.deviation;
      d = arbitrate(g, p, memory);
      if (i == 29) {
        EXPECT_LT(d.held.renderScale, 0.8);
      }
    }
    EXPECT_EQ(d.held.renderScale == 1, c.restores) << c.deviation << ' ' << c.caution << ' ' << explain(d);
  }
}

/// Returns how often a minute's images exchange levels while the eye moves and the allowed error is the only
/// lever; `change` makes the load or the machine of image i.
int exchangesInAMinute(const std::function<void(HoldGiven&, int i)>& change) {
  HoldMemory memory;
  HoldParameters p = enabled();
  p.renderScaleMinimum = p.particlesMinimum = Ratio{1};
  int exchanges = 0;
  double last = 0;
  for (int i = 0; i < 60 * 60; ++i) {
    HoldGiven g = given(i / 60.0);
    g.budgetMs = 36;
    g.moves = true;
    g.blurs = false;
    change(g, i);
    const HoldDecision d = arbitrate(g, p, memory);
    exchanges += i > 0 && d.held.errorPx != last;
    last = d.held.errorPx;
  }
  return exchanges;
}

/// A machine that takes 1.8 times as long for triangles during a quarter of the time.
TEST(Arbiter, patienceOutlastsAMovingEye) {
  const int exchanges =
      exchangesInAMinute([](HoldGiven& g, int i) { g.cost.perTriangle *= i % 80 < 20 ? 1.8 : 1; });
  EXPECT_GT(exchanges, 2) << "it tries";
  EXPECT_LE(exchanges, 25) << "65 where patience ends within hold.calm_ms";
}

/// A load that leaves ample room in every other second: an eye that flies over hills, or a head that looks
/// around.
TEST(Arbiter, levelsReturnMoreSeldomWhereTheLoadComesBack) {
  const int exchanges = exchangesInAMinute([](HoldGiven& g, int i) {
    for (double& triangles : g.triangles) triangles *= i % 120 < 60 ? 4 : 1;
  });
  EXPECT_GT(exchanges, 2) << "it tries";
  EXPECT_LE(exchanges, 20) << "34 where ample room returns them after 0.4 s each time";
}

/// A calm of nothing, or of less than an image, must not keep the error from returning while the eye moves.
TEST(Arbiter, theErrorReturnsWithAnyCalm) {
  for (const double calmMs : {0.0, 10.0, 120.0, 300.0}) {
    HoldMemory memory;
    double returnedMs = 0;
    for (int i = 0; i < 400 && returnedMs == 0; ++i) {
      HoldGiven g = given(i / 60.0);
      g.budgetMs = 44;
      g.moves = true;
      for (double& triangles : g.triangles) triangles *= i < 50 ? 8 : 1;
      HoldParameters p = enabled();
      p.renderScaleMinimum = Ratio{1};
      p.calm = Milliseconds{calmMs};
      if (arbitrate(g, p, memory).held.errorPx == 1 && i > 50) returnedMs = (i - 50) * 1000 / 60.0;
    }
    EXPECT_NEAR(returnedMs, 400, 40) << calmMs;
  }
}

TEST(Arbiter, whileTheEyeMovesTheErrorReturnsAfterASecondOrSoonerWithAmpleRoom) {
  struct Case {
    bool moves;
    double load;  ///< before, over that afterwards
    double afterMs;
  };
  for (const Case& c :
       {Case{true, 1.7, 1000}, Case{true, 8, 400}, Case{false, 1.7, enabled().calm.value()}}) {
    HoldMemory memory;
    double returnedMs = 0;
    for (int i = 0; i < 300 && returnedMs == 0; ++i) {
      HoldGiven g = given(i / 100.0);
      g.budgetMs = 44;
      g.moves = c.moves;
      for (double& triangles : g.triangles) triangles *= i < 50 ? c.load : 1;
      HoldParameters p = enabled();
      p.renderScaleMinimum = Ratio{1};
      const HoldDecision d = arbitrate(g, p, memory);
      if (i < 50) {
        EXPECT_GT(d.held.errorPx, 1) << c.load;
      } else if (d.held.errorPx == 1) {
        returnedMs = (i - 50) * 10;
      }
    }
    EXPECT_NEAR(returnedMs, c.afterMs, 25) << c.moves << ' ' << c.load;
  }
}

}  // namespace
}  // namespace trimtab
