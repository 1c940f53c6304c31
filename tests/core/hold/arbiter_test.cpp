#include "trimtab/hold/arbiter.h"
#include "trimtab/units/not_finite.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "arbiter_input.h"

namespace trimtab {
namespace {

using test::enabled;
using test::given;

/// Every setting that the arbiter may choose, written a second time and on purpose without its tables.
struct Twin {
  double loss = kInfinity, ms = kInfinity;
};
Twin leastLoss(const HoldGiven& g, const HoldParameters& p, double limitMs) {
  Twin best;
  std::vector<double> errors{g.asked.errorPx};
  for (int i = 0; i <= 9 * 16; ++i)
    if (const double e = std::pow(2, i / 16.0 - 3);
        e > g.asked.errorPx && e <= p.errorMaximum.value() * 1.000001)
      errors.push_back(e);
  for (const double errorPx : errors)
    for (int s = 0; g.asked.renderScale - 0.05 * s >= p.renderScaleMinimum.value() - 1e-9; ++s)
      for (int k = 0; g.asked.particleShare - 0.125 * k >= p.particlesMinimum.value() - 1e-9; ++k)
        for (const double blur : {g.asked.blurShare, p.blurMinimum.value()}) {
          const double scale = g.asked.renderScale - 0.05 * s, share = g.asked.particleShare - 0.125 * k;
          const HeldLevers levers{errorPx, scale, share, blur};
          const double ms =
              predict(g.cost, loadOf(g, levers, trianglesAt(g.triangles, g.asked.errorPx, errorPx))).total();
          if (ms > limitMs) continue;
          const double loss =
              p.lossError.value() * std::max(std::pow(errorPx, 1.5) - std::pow(g.asked.errorPx, 1.5), 0.0) /
                  63 +
              p.lossRenderScale.value() * std::pow(std::max(g.asked.renderScale / scale - 1, 0.0), 0.5) +
              p.lossParticles.value() * (g.asked.particleShare - share) +
              p.lossBlur.value() * (g.asked.blurShare - blur);
          if (loss < best.loss) best = {loss, ms};
        }
  return best;
}

double lossOf(const HoldGiven& g, const HoldParameters& p, const HeldLevers& held) {
  return p.lossError.value() * std::max(std::pow(held.errorPx, 1.5) - std::pow(g.asked.errorPx, 1.5), 0.0) /
             63 +
         p.lossRenderScale.value() *
             std::pow(std::max(g.asked.renderScale / held.renderScale - 1, 0.0), 0.5) +
         p.lossParticles.value() * (g.asked.particleShare - held.particleShare) +
         p.lossBlur.value() * (g.asked.blurShare - held.blurShare);
}

TEST(Arbiter, leavesWhatFitsAlone) {
  HoldMemory memory;
  const HoldDecision d = arbitrate(given(), enabled(), memory);
  EXPECT_EQ(d.reason, HoldReason::fits);
  EXPECT_EQ(d.held, d.asked);
  EXPECT_DOUBLE_EQ(d.askedMs.total(), 2 + 10 + 18 + 2 + 4 + 3 + 1);
}

TEST(Arbiter, losesAsLittleAsAnySettingThatFits) {
  std::mt19937 random(5);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  for (int i = 0; i < 300; ++i) {
    HoldGiven g = given();
    g.asked = {between(0.3, 8), between(0.5, 1), between(0.25, 1), 1};
    g.cost.perGroundMpx = between(0, 60);
    g.cost.perParticles = between(0, 60);
    g.cost.perTriangle = between(0, 5e-4);
    g.budgetMs = between(10, 100);
    HoldParameters p = enabled();
    p.lossError = Ratio{between(0, 0.1)};
    p.lossRenderScale = Ratio{between(0, 0.1)};
    p.lossParticles = Ratio{between(0, 0.1)};
    p.lossBlur = Ratio{between(0, 0.1)};
    HoldMemory memory;
    const HoldDecision d = arbitrate(g, p, memory);
    const Twin twin = leastLoss(g, p, d.limitMs);
    if (std::isinf(twin.loss)) {
      EXPECT_EQ(d.reason, HoldReason::out_of_reach) << i;
      continue;
    }
    EXPECT_LE(d.heldMs.total(), d.limitMs) << i;
    EXPECT_NEAR(lossOf(g, p, d.held), twin.loss, 1e-12) << i;
  }
}

TEST(Arbiter, saysWhatEachLeverTakesOffAndTheyAddUp) {
  const HoldParameters p = enabled();
  HoldGiven g = given();
  HoldDecision d;
  d.asked = d.held = g.asked;
  EXPECT_EQ(gainsOf(g, d, p), HoldGains{}) << "nothing is lowered";
  // A single lever gives all of the difference.
  d.held.particleShare = 0.5;
  HoldGains gains = gainsOf(g, d, p);
  EXPECT_DOUBLE_EQ(gains.particles.ms, 1.5);
  EXPECT_DOUBLE_EQ(gains.particles.loss, p.lossParticles.value() / 2);
  EXPECT_EQ(gains.error, LeverGain{});
  // Alone, the levers take off 5, 18, 1.5 and 3 ms. A smaller scene has less blur to draw, so together they
  // take off 2.25 ms less, which all share.
  d.held = {2, 0.5, 0.5, 0};
  gains = gainsOf(g, d, p);
  EXPECT_NEAR(gains.error.ms, 5 * 25.25 / 27.5, 1e-9);
  EXPECT_NEAR(gains.renderScale.ms, 0.75 * (20 + 1 + 3) * 25.25 / 27.5, 1e-9);
  EXPECT_NEAR(gains.blur.ms, 3 * 25.25 / 27.5, 1e-9);
  const double all = gains.error.ms + gains.renderScale.ms + gains.particles.ms + gains.blur.ms;
  const double held =
      predict(g.cost, loadOf(g, d.held, trianglesAt(g.triangles, d.asked.errorPx, d.held.errorPx))).total();
  EXPECT_NEAR(all, 40 - held, 1e-9);
  g.cost.fixed = kNan;
  EXPECT_EQ(gainsOf(g, d, p), HoldGains{});
}

TEST(Arbiter, leavesRoomForItsOwnUncertainty) {
  const auto limitAt = [](double halfBandMs, double caution = enabled().caution.value()) {
    HoldGiven g = given();
    g.budgetMs = 30;
    g.cost.halfBandMs = halfBandMs;
    HoldParameters p = enabled();
    p.caution = Ratio{caution};
    HoldMemory memory;
    return arbitrate(g, p, memory).limitMs;
  };
  const double sure = 30 * (1 - enabled().margin.value());
  EXPECT_DOUBLE_EQ(limitAt(0), sure);
  EXPECT_DOUBLE_EQ(limitAt(2), sure);
  EXPECT_NEAR(limitAt(5), 33 - 5 * 2.326 / 1.645, 0.02) << "one image in a hundred beyond 1.1 of the budget";
  EXPECT_DOUBLE_EQ(limitAt(1000), 0.75 * 30) << "an image need not be sure at any price";
  EXPECT_DOUBLE_EQ(limitAt(5, 2), 33 - 5 * 2);
  EXPECT_DOUBLE_EQ(limitAt(1000, 0), sure) << "without caution half of the images may be late";
  EXPECT_DOUBLE_EQ(limitAt(kInfinity), sure);
  EXPECT_DOUBLE_EQ(limitAt(kNan), sure);
  EXPECT_DOUBLE_EQ(limitAt(-1), sure);
}

TEST(Arbiter, restsWhileItsInputsRest) {
  std::mt19937 random(11);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  for (int flight = 0; flight < 50; ++flight) {
    HoldMemory memory;
    HoldGiven g = given();
    g.budgetMs = between(12, 60);
    g.cost.perGroundMpx = between(0, 80);
    HeldLevers last;
    int lastChange = 0;
    for (int i = 0; i < 400; ++i) {
      g.timeS = i / 60.0;
      const HoldDecision d = arbitrate(g, enabled(), memory);
      if (d.held != last) lastChange = i;
      last = d.held;
    }
    EXPECT_LE(lastChange, 30) << flight;
  }
}

TEST(Arbiter, goesBackAndForthBetweenNoSettingsThatTakeTheSameTime) {
  std::mt19937 random(5);
  HoldMemory memory;
  int changes = 0;
  HeldLevers last;
  for (int i = 0; i < 600; ++i) {
    HoldGiven g = given(i / 60.0);
    g.budgetMs = 5;                                               // out of reach
    for (std::size_t k = kPlacesPerOctave; k < kErrorSteps; ++k)  // noise decides which is the quickest
      g.triangles[k] = 5e4 + std::uniform_real_distribution<double>(0, 100)(random);
    const HoldDecision d = arbitrate(g, enabled(), memory);
    EXPECT_EQ(d.reason, HoldReason::out_of_reach);
    changes += i > 0 && d.held != last;
    last = d.held;
  }
  EXPECT_EQ(changes, 0);
}

TEST(Arbiter, givesUpHardlyMoreThanTheBudgetAsks) {
  std::mt19937 random(13);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  for (int view = 0; view < 100; ++view) {
    HoldMemory memory;
    HoldGiven g = given();
    g.cost.perTriangle = between(1e-4, 4e-4);
    const double asked = predict(g.cost, loadOf(g, g.asked, g.triangles[0])).total();
    const double trianglesMs = g.cost.perTriangle * g.triangles[0];
    g.budgetMs = asked - between(0.1, 0.7) * trianglesMs;
    HoldParameters p = enabled();
    p.margin = Ratio{0};
    HoldDecision d;
    for (int i = 0; i < 60; ++i) {
      g.timeS = i / 60.0;
      d = arbitrate(g, p, memory);
    }
    EXPECT_LE(d.heldMs.total(), d.limitMs) << view;
    // What lowering leaves free, and a sixteenth of an octave of the triangles.
    EXPECT_GE(d.heldMs.total(), d.limitMs * 0.92 - 0.05 * trianglesMs) << view;
  }
}

TEST(Arbiter, coarsensThroughAGlanceAndComesBackAfterIt) {
  HoldMemory memory;
  int coarser = 0, finer = 0, turns = 0;
  double last = 1;
  for (int i = 0; i < 300; ++i) {
    HoldGiven g = given(i / 100.0);
    g.budgetMs = 44;
    // The load rises and falls over a second while the line of sight sweeps through 180 degrees.
    const bool sweeps = i >= 50 && i < 150;
    const double part = sweeps ? std::sin((i - 50) / 100.0 * 3.14159) : 0;
    for (double& triangles : g.triangles) triangles *= 1 + 2 * part;
    HoldParameters p = enabled();
    p.renderScaleMinimum = Ratio{1};
    const HoldDecision d = arbitrate(g, p, memory);
    turns += d.held.errorPx > last && finer > 0;
    coarser += d.held.errorPx > last;
    finer += d.held.errorPx < last;
    last = d.held.errorPx;
  }
  EXPECT_GT(coarser, 0);
  EXPECT_LE(coarser, 5) << "as the load rises";
  EXPECT_GT(finer, 0);
  EXPECT_LE(finer, 2) << "once it has fallen";
  EXPECT_EQ(turns, 0);
}

/// A load that rises and falls by a third while the eye moves: the other levers follow it.
TEST(Arbiter, leavesLevelsAloneWhereOtherLeversServeNearlyAsWell) {
  constexpr int kFirst = 100;
  int exchanges = 0, changes = 0;
  for (double budgetMs = 10; budgetMs < 26; ++budgetMs) {
    HoldMemory memory;
    HeldLevers last;
    for (int i = 0; i < 2000; ++i) {
      HoldGiven g = given(i / 60.0);
      g.budgetMs = budgetMs;
      const double load = 1 + 0.33 * std::sin(i / 60.0);
      for (double& triangles : g.triangles) triangles *= load;
      g.cost.perTriangle *= 4;
      g.cost.perGroundMpx *= 0.5 * load;
      const HoldDecision d = arbitrate(g, enabled(), memory);
      exchanges += i > kFirst && d.held.errorPx != last.errorPx;
      changes += i > kFirst && d.held != last;
      last = d.held;
    }
  }
  std::printf("%d of %d changes exchange levels\n", exchanges, changes);
  EXPECT_GT(changes, 500);
  EXPECT_LE(exchanges, 50) << "205 where levels are exchanged for any gain";
}

TEST(Arbiter, anUnknownBudgetOrCostChangesNothing) {
  for (const double budget : {0.0, -5.0, kNan, kInfinity}) {
    HoldMemory memory;
    HoldGiven g = given();
    g.budgetMs = budget;
    const HoldDecision d = arbitrate(g, enabled(), memory);
    EXPECT_EQ(d.reason, HoldReason::no_budget) << budget;
    EXPECT_EQ(d.held, g.asked) << budget;
  }
  for (const auto spoil :
       {+[](HoldGiven& g) { g.cost.known = false; }, +[](HoldGiven& g) { g.cost.fixed = kNan; },
        +[](HoldGiven& g) { g.triangles[3] = kInfinity; }, +[](HoldGiven& g) { g.groundMpx = kNan; }}) {
    HoldMemory memory;
    HoldGiven g = given();
    spoil(g);
    const HoldDecision d = arbitrate(g, enabled(), memory);
    EXPECT_EQ(d.reason, HoldReason::cost_unknown);
    EXPECT_EQ(d.held, g.asked);
  }
}

TEST(Arbiter, aBudgetBelowAnEmptySkyTakesNextToTheQuickestSettingAndSaysSo) {
  HoldMemory memory;
  HoldGiven g = given();
  g.budgetMs = 0.5;
  const HoldDecision d = arbitrate(g, enabled(), memory);
  EXPECT_EQ(d.reason, HoldReason::out_of_reach);
  EXPECT_DOUBLE_EQ(d.held.renderScale, 0.5);
  EXPECT_DOUBLE_EQ(d.held.particleShare, 0.25);
  EXPECT_DOUBLE_EQ(d.held.blurShare, 0);
  const HeldLevers least{16, 0.5, 0.25, 0};
  const double quickestMs = predict(g.cost, loadOf(g, least, trianglesAt(g.triangles, 1, 16))).total();
  EXPECT_LE(d.heldMs.total(), 1.02 * quickestMs);
  EXPECT_LT(d.held.errorPx, 16) << "the last pixels of error win next to nothing";
}

/// A processor that does the same whatever is drawn.
TEST(Arbiter, leavesTheLeversAloneWhereLoweringThemWinsNothing) {
  HoldMemory memory;
  for (int i = 0; i < 100; ++i) {
    HoldGiven g = given(i / 60.0);
    static_cast<ClockCoefficients&>(g.cost) = {};
    g.cost.fixed = 30 + i % 3;
    g.cost.perGroundMpx = 0.5;
    g.budgetMs = 10;
    const HoldDecision d = arbitrate(g, enabled(), memory);
    EXPECT_EQ(d.reason, HoldReason::out_of_reach);
    EXPECT_EQ(d.held, d.asked) << i;
  }
}

TEST(Arbiter, leavesTheLeversAloneWhilePredictionsAreOffAndComesBack) {
  HoldMemory memory;
  HoldGiven g = given();
  g.budgetMs = 20;
  const auto reasonAt = [&](double offMs) {
    g.cost.offMs = offMs;
    g.timeS += 1 / 60.0;
    const HoldDecision d = arbitrate(g, enabled(), memory);
    EXPECT_EQ(d.held == d.asked, d.reason == HoldReason::not_trusted) << offMs;
    EXPECT_FALSE(explain(d).empty());
    return d.reason;
  };
  EXPECT_EQ(reasonAt(5.9), HoldReason::lowered);
  EXPECT_EQ(reasonAt(6.1), HoldReason::not_trusted);
  EXPECT_EQ(reasonAt(3.1), HoldReason::not_trusted) << "it does not come and go";
  EXPECT_EQ(reasonAt(2.9), HoldReason::lowered);
  EXPECT_EQ(reasonAt(5.9), HoldReason::held);
}

TEST(Arbiter, aClockThatStandsOrGoesBackNeverRestores) {
  for (const double step : {0.0, -0.1, kNan}) {
    HoldMemory memory;
    HoldGiven heavy = given();
    heavy.budgetMs = 20;
    arbitrate(heavy, enabled(), memory);
    HoldDecision d;
    for (int i = 1; i < 200; ++i) d = arbitrate(given(i * step), enabled(), memory);
    EXPECT_EQ(d.reason, HoldReason::held) << step;
  }
}

TEST(Arbiter, aClockThatJumpsAheadDoesNotRestore) {
  HoldMemory memory;
  HoldGiven heavy = given();
  heavy.budgetMs = 20;
  arbitrate(heavy, enabled(), memory);
  // Two jumps of an hour are not calm; three images are.
  EXPECT_EQ(arbitrate(given(3600), enabled(), memory).reason, HoldReason::held);
  EXPECT_EQ(arbitrate(given(7200), enabled(), memory).reason, HoldReason::held);
  EXPECT_EQ(arbitrate(given(7200.3), enabled(), memory).reason, HoldReason::restored);
}

TEST(Arbiter, neverGoesBeyondTheEngineersLimits) {
  HoldMemory memory;
  HoldParameters p = enabled();
  p.errorMaximum = Pixels{3};
  p.renderScaleMinimum = Ratio{0.8};
  p.particlesMinimum = Ratio{0.6};
  p.blurMinimum = Ratio{0.5};
  HoldGiven g = given();
  g.budgetMs = 1;
  const HoldDecision d = arbitrate(g, p, memory);
  EXPECT_LE(d.held.errorPx, 3);
  EXPECT_GE(d.held.renderScale, 0.8 - 1e-12);
  EXPECT_GE(d.held.particleShare, 0.6);
  EXPECT_GE(d.held.blurShare, 0.5);
}

/// An engineer fixes an order by losses that are far apart: a lever moves only where those before it, moved
/// as far as they may, are not enough.
TEST(Arbiter, lossesFarApartAreAnOrder) {
  HoldParameters p = enabled();
  p.lossParticles = Ratio{0};
  p.lossRenderScale = Ratio{1e-5};
  p.lossError = p.lossBlur = Ratio{1};
  bool scaled = false, coarser = false;
  for (double budgetMs = 45; budgetMs > 8; budgetMs -= 0.5) {
    HoldMemory memory;
    HoldGiven g = given();
    g.blurs = false;
    g.budgetMs = budgetMs;
    const HoldDecision d = arbitrate(g, p, memory);
    const auto msWith = [&](double scale) {
      return predict(g.cost, loadOf(g, {1, scale, p.particlesMinimum.value(), 1}, g.triangles[0])).total();
    };
    if (d.held.renderScale < 1) {
      EXPECT_GT(msWith(1), d.limitMs) << budgetMs;
    }
    if (d.held.errorPx > 1) {
      EXPECT_GT(msWith(p.renderScaleMinimum.value()), d.limitMs) << budgetMs;
    }
    scaled = scaled || d.held.renderScale < 1, coarser = coarser || d.held.errorPx > 1;
  }
  EXPECT_TRUE(scaled);
  EXPECT_TRUE(coarser);
}

TEST(Arbiter, keepsACoarserErrorThanItsLimitIfThatIsAskedFor) {
  HoldMemory memory;
  HoldParameters p = enabled();
  p.errorMaximum = Pixels{3};
  HoldGiven g = given();
  g.asked.errorPx = 5;
  g.budgetMs = 1;
  EXPECT_EQ(arbitrate(g, p, memory).held.errorPx, 5);
}

}  // namespace
}  // namespace trimtab
