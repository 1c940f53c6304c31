#include "trimtab/policy/lever_drive.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/core/policy/random_policy.h"
#include "trimtab/policy/compiled_policy.h"
#include "trimtab/units/not_finite.h"

namespace trimtab {
namespace {

LeverValues neutral() {
  LeverValues values;
  for (const LeverRow& row : kLeverRows)
    values[row.lever] = std::isnan(row.neutral) ? row.usual.low : row.neutral;
  return values;
}

double change(const LeverRow& row, double from, double to) {
  return std::abs(row.logarithmic ? std::log2(to / from) : to - from);
}

TEST(LeverDrive, takesTheFirstTargetsAtOnceAndNoJumpAfterwards) {
  LeverDrive drive;
  LeverValues target = neutral();
  target[Lever::lod_scale] = 4;
  EXPECT_EQ(drive.follow(10, target, neutral())[Lever::lod_scale], 4);
  target[Lever::lod_scale] = 1;
  EXPECT_DOUBLE_EQ(drive.follow(10.125, target, neutral())[Lever::lod_scale], 4 / std::sqrt(2));
  EXPECT_DOUBLE_EQ(drive.follow(10.5, target, neutral())[Lever::lod_scale], 4 / std::sqrt(2) / 2)
      << "a gap is a quarter second";
  EXPECT_EQ(drive.follow(10.75, target, neutral())[Lever::lod_scale], 1);
  target[Lever::lod_scale] = kNan;
  EXPECT_EQ(drive.follow(11, target, neutral())[Lever::lod_scale], 1) << "the neutral value";
}

TEST(LeverDrive, doesNotMoveForLessThanTheDeadBandAndArrivesExactly) {
  LeverDrive drive;
  LeverValues target = neutral();
  drive.follow(0, target, neutral());
  target[Lever::particle_density] = 0.995;
  EXPECT_EQ(drive.follow(0.1, target, neutral())[Lever::particle_density], 1);
  target[Lever::particle_density] = 0.7;
  double t = 0.1, last = 1;
  while (last != 0.7 && t < 1) {
    const double value = drive.follow(t += 0.02, target, neutral())[Lever::particle_density];
    EXPECT_LT(value, last);
    last = value;
  }
  EXPECT_EQ(last, 0.7);
  EXPECT_NEAR(t, 0.1 + 0.3 / rowOf(Lever::particle_density).ratePerS, 0.021);
}

TEST(LeverDrive, standsWhileTimeStandsGoesBackOrIsNotANumber) {
  LeverDrive drive;
  LeverValues target = neutral();
  drive.follow(100, target, neutral());
  target[Lever::render_scale] = 0.5;
  for (const double time : {100.0, 99.0, 98.0, kNan, kInfinity, -kInfinity})
    EXPECT_EQ(drive.follow(time, target, neutral())[Lever::render_scale], 1) << time;
  EXPECT_LT(drive.follow(98.1, target, neutral())[Lever::render_scale], 1)
      << "it goes on from where time is now";
  drive.restart();
  EXPECT_EQ(drive.follow(5, target, neutral())[Lever::render_scale], 0.5);
}

/// 10,000 random rule bases: a step, a ramp, noise and rest on every signal, and one that nobody knows for a
/// while.
TEST(LeverDrive, keepsRangeAndRateAndRestsForAnyRuleBase) {
  std::mt19937_64 random(17);
  std::normal_distribution<double> noise;
  std::size_t moves = 0;
  for (int i = 0; i < 10000; ++i) {
    const Policy policy = test::randomPolicy(random, {.signals = 4, .terms = 8, .rules = 6, .levers = 7});
    const auto compiled = compile(policy, "test");
    ASSERT_TRUE(compiled) << toString(compiled.findings());
    LeverDrive drive;
    PolicyDecision decision;
    SignalValues signals = test::randomSignals(random, policy);
    LeverValues last;
    double t = 1e9 * noise(random);
    const SignalValues end = test::randomSignals(random, policy);
    SignalValues begin;
    const std::size_t unknown = random() % kSignalRows.size();
    for (int frame = 0; frame < 50; ++frame) {
      if (frame == 10) signals = begin = test::randomSignals(random, policy);  // a step
      if (frame >= 30 && frame <= 40)                                          // a ramp
        for (std::size_t s = 0; s < kSignalRows.size(); ++s)
          signals.value[s] = begin.value[s] + (end.value[s] - begin.value[s]) * (frame - 30) / 10;
      SignalValues noisy = signals;
      if (frame >= 15 && frame < 20) noisy.value[unknown] = kNan;
      if (frame < 40)
        for (const SignalRow& row : kSignalRows)
          noisy[row.signal] += 0.01 * noise(random) * std::min(row.range.high - row.range.low, 1e5);
      const double dt = frame % 7 == 6 ? 0.2 : 0.016;
      t += dt;
      compiled->decide(noisy, decision);
      const LeverValues now = drive.follow(t, decision.target, neutral());
      for (const LeverRow& row : kLeverRows) {
        const double value = now[row.lever];
        ASSERT_TRUE(value >= row.hard.low && value <= row.hard.high) << row.key << " " << value;
        if (frame > 0) {
          ASSERT_LE(change(row, last[row.lever], value), row.ratePerS * (dt + 1e-6)) << row.key;
          moves += value != last[row.lever];
        }
      }
      last = now;
    }
    // At rest: one direction only, and then none.
    compiled->decide(signals, decision);
    std::array<int, kLevers> direction{};
    for (int frame = 0; frame < 60; ++frame) {
      const LeverValues now = drive.follow(t += 0.1, decision.target, neutral());
      for (std::size_t l = 0; l < kLevers; ++l) {
        const int sign = (now.value[l] > last.value[l]) - (now.value[l] < last.value[l]);
        ASSERT_TRUE(sign == 0 || direction[l] == 0 || sign == direction[l])
            << kLeverRows[l].key << " turns round";
        if (sign != 0) direction[l] = sign;
        ASSERT_TRUE(frame < 40 || sign == 0) << kLeverRows[l].key << " does not rest";
      }
      last = now;
    }
  }
  EXPECT_GT(moves, 100000u);
}

}  // namespace
TEST(LeverDrive, theValueOfThePresetIsNotBoundToWhatRulesMayAsk) {
  LeverValues preset = neutral();
  preset[Lever::screen_space_error] = 128;
  LeverDrive drive;
  EXPECT_EQ(drive.follow(0, {}, preset)[Lever::screen_space_error], 128);
  LeverValues asked;
  asked[Lever::screen_space_error] = 1000;
  drive.restart();
  EXPECT_EQ(drive.follow(0, asked, preset)[Lever::screen_space_error],
            rowOf(Lever::screen_space_error).hard.high);
}

}  // namespace trimtab
