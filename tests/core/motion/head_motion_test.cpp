#include "trimtab/motion/head_motion.h"
#include "trimtab/units/not_finite.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>
#include <utility>

#include "pilot.h"

namespace trimtab {
namespace {

using test::Pilot;

constexpr double kFast = 180, kSlow = 10;  // deg/s against 60

TEST(FovMovement, isFastAboveOneFieldOfViewASecondWhateverTheFrameRate) {
  for (const double fps : {20.0, 59.94, 100.0, 450.0}) {
    Pilot pilot;
    EXPECT_FALSE(pilot.turn(59.9, 1 / fps).fast) << fps;
    EXPECT_FALSE(pilot.turn(60, 1 / fps).fast) << "exactly the threshold at " << fps;
    EXPECT_TRUE(pilot.turn(60.1, 1 / fps).fast) << fps;
    EXPECT_FALSE(pilot.turn(-59.9, 1 / fps).fast) << fps;
    const MotionDecision left = pilot.turn(-75, 1 / fps);
    EXPECT_TRUE(left.fast);
    EXPECT_NEAR(left.rateDegPerS, 75, 1e-6);
    EXPECT_EQ(left.thresholdDegPerS, 60);
  }
}

TEST(FovMovement, dividesByTheAverageRateOfImagesWhereTheyAreCounted) {
  MotionParameters p;
  p.frames = MotionFrames::drawn;
  MotionMemory memory;
  AircraftState state;
  decideMotion(state, p, memory);
  // An image took 50 ms of an average of 10: its 1.5 degrees are more than 60 / 100.
  const auto turned = [&](double degrees, const DrawnLoad& drawn) {
    MotionMemory from = memory;
    AircraftState next = state;
    next.time = 0.05;
    next.attitude.heading = Degrees{degrees};
    return decideMotion(next, p, from, drawn);
  };
  EXPECT_TRUE(turned(1.5, {100, {}, {}}).fast);
  EXPECT_NEAR(turned(1.5, {100, {}, {}}).rateDegPerS, 150, 1e-9);
  EXPECT_FALSE(turned(0.6, {100, {}, {}}).fast) << "exactly the threshold";
  EXPECT_TRUE(turned(0.601, {100, {}, {}}).fast);
  for (const std::optional<double> unknown :
       {std::optional<double>{}, std::optional(0.0), std::optional(-1.0), std::optional(kNan),
        std::optional(kInfinity)})
    EXPECT_NEAR(turned(1.5, {unknown, {}, {}}).rateDegPerS, 30, 1e-9) << "by the step";
  p.frames = MotionFrames::host_states;
  EXPECT_NEAR(turned(1.5, {100, {}, {}}).rateDegPerS, 30, 1e-9) << "the rate of images does not matter";
}

TEST(FovMovement, takesTheLargerOfHeadingAndPitch) {
  Pilot pilot;
  pilot.pitch = 0.7;
  const MotionDecision nod = pilot.turn(50);
  EXPECT_TRUE(nod.fast);
  EXPECT_NEAR(nod.rateDegPerS, 70, 1e-9);
  pilot.pitch = 1.2;
  EXPECT_NEAR(pilot.turn(55).rateDegPerS, 55, 1e-9) << "not their sum";
}

TEST(FovMovement, unwindsThePassageThroughNorth) {
  Pilot pilot;
  pilot.heading = 359;
  pilot.turn(0);
  pilot.heading = 1;
  EXPECT_NEAR(pilot.turn(0).rateDegPerS, 200, 1e-6) << "2 degrees in 10 ms";
  pilot.heading = 359;
  EXPECT_NEAR(pilot.turn(0).rateDegPerS, 200, 1e-6) << "and back";
  pilot.heading = 719.5;
  EXPECT_NEAR(pilot.turn(0).rateDegPerS, 50, 1e-6) << "a winding heading is the same direction";
}

TEST(FovMovement, watchesAircraftAndHeadOrTheHeadAlone) {
  for (const bool headAlone : {false, true}) {
    MotionParameters p;
    p.reference = headAlone ? MotionReference::head : MotionReference::line_of_sight;
    MotionMemory memory;
    AircraftState state;
    decideMotion(state, p, memory);
    state.time = 0.01;
    state.attitude.heading = Degrees{1};
    EXPECT_EQ(decideMotion(state, p, memory).fast, !headAlone);
    state.time = 0.02;
    state.attitude.heading = Degrees{2};
    state.head = Attitude{Degrees{-1}, Degrees{0}, Degrees{0}};
    // The head turns against the aircraft: the picture stands still.
    EXPECT_EQ(decideMotion(state, p, memory).fast, headAlone);
  }
}

TEST(BlurStack, firesWithTheTenthFastFrameInARow) {
  Pilot pilot;
  for (std::uint32_t i = 1; i < 10; ++i) {
    const MotionDecision d = pilot.turn(kFast);
    EXPECT_EQ(d.reason, MotionReason::fast);
    EXPECT_EQ(d.blurStack.frames, i);
    EXPECT_NEAR(d.blurStack.ms, 10.0 * i, 1e-6);
    EXPECT_NEAR(d.blurStack.variationDeg, 1.8 * i, 1e-6);
    EXPECT_EQ(d.lodScale, 1) << i << " are not enough";
    EXPECT_EQ(d.blur.strength, 0);
  }
  const MotionDecision d = pilot.turn(kFast);
  EXPECT_EQ(d.reason, MotionReason::lowered);
  EXPECT_EQ(d.level, 1u);
  EXPECT_EQ(d.lodScale, 2);
  EXPECT_EQ(d.blur, (MotionBlur{0.8, 400})) << "level and blur change together";
  EXPECT_EQ(d.blurStack, MotionStack{}) << "firing empties it";
}

TEST(BlurStack, isEmptiedByASlowFrame) {
  Pilot pilot;
  pilot.turns(9, kFast);
  EXPECT_EQ(pilot.turn(kSlow).blurStack, MotionStack{});
  EXPECT_EQ(pilot.turns(9, kFast).reason, MotionReason::fast);
  EXPECT_EQ(pilot.turn(kFast).reason, MotionReason::lowered);
}

TEST(BlurStack, firesAgainWhileTheMotionGoesOnDownToTheLargestScale) {
  Pilot pilot;
  EXPECT_EQ(pilot.turns(10, kFast).lodScale, 2);
  EXPECT_EQ(pilot.turns(9, kFast).lodScale, 2);
  const MotionDecision second = pilot.turn(kFast);
  EXPECT_EQ(second.lodScale, 4);
  EXPECT_EQ(second.blur.remainingMs, 400) << "renewed";
  const MotionDecision third = pilot.turns(10, kFast);
  EXPECT_EQ(third.reason, MotionReason::lowest);
  EXPECT_EQ(third.lodScale, 4);
  EXPECT_EQ(third.level, 2u);
  EXPECT_EQ(third.blur.remainingMs, 400);
}

TEST(Blur, isAsStrongAsTheRunThatStartsItIsFast) {
  MotionParameters p;
  p.blurFullRate = DegreesPerSecond{180};
  for (const double rate : {70.0, 90.0, 135.0, 180.0, 400.0}) {
    Pilot pilot(p);
    EXPECT_NEAR(pilot.turns(10, rate).blur.strength, 0.8 * std::min(rate / 180, 1.0), 1e-9) << rate;
    Pilot constant;
    EXPECT_EQ(constant.turns(10, rate).blur.strength, 0.8) << "by default it does not follow the speed";
  }
  Pilot pilot(p);
  pilot.turns(5, 90);
  EXPECT_NEAR(pilot.turns(5, 150).blur.strength, 0.8 * 120 / 180, 1e-9) << "the mean of the run";
  EXPECT_NEAR(pilot.turns(9, 180).blur.strength, 0.8 * 120 / 180, 1e-9) << "until the next run is full";
  EXPECT_NEAR(pilot.turn(180).blur.strength, 0.8, 1e-9);
  EXPECT_NEAR(pilot.turns(5, kSlow).blur.strength, 0.8, 1e-9) << "slow frames stop it and do not weaken it";
  EXPECT_EQ(pilot.turn(kSlow).blur.strength, 0);
}

TEST(LodRestoreStack, firesWithTheSixthSlowFrameInARow) {
  Pilot pilot;
  pilot.turns(20, kFast);
  for (std::uint32_t i = 1; i < 6; ++i) {
    const MotionDecision d = pilot.turn(kSlow);
    EXPECT_EQ(d.reason, MotionReason::slow);
    EXPECT_EQ(d.restoreStack.frames, i);
    EXPECT_EQ(d.lodScale, 4) << i << " are not enough";
    EXPECT_GT(d.blur.strength, 0);
  }
  const MotionDecision d = pilot.turn(kSlow);
  EXPECT_EQ(d.reason, MotionReason::raised);
  EXPECT_EQ(d.lodScale, 2);
  EXPECT_EQ(d.blur, MotionBlur{}) << "stopped";
  EXPECT_EQ(d.restoreStack, MotionStack{});
  EXPECT_EQ(pilot.turns(5, kSlow).lodScale, 2);
  EXPECT_EQ(pilot.turn(kSlow).lodScale, 1) << "and fires again";
  EXPECT_EQ(pilot.turns(6, kSlow).reason, MotionReason::slow) << "at full detail it changes nothing";
}

TEST(LodRestoreStack, isEmptiedByAFastFrame) {
  Pilot pilot;
  pilot.turns(10, kFast);
  pilot.turns(5, kSlow);
  const MotionDecision d = pilot.turn(kFast);
  EXPECT_EQ(d.restoreStack, MotionStack{});
  EXPECT_EQ(d.blurStack.frames, 1u);
  EXPECT_EQ(pilot.turns(5, kSlow).lodScale, 2);
  EXPECT_EQ(pilot.turn(kSlow).lodScale, 1);
}

TEST(LodRestoreStack, stopsABlurThatStartedAtTheOnlyLevel) {
  MotionParameters p;
  p.lodMaximum = Ratio{1};
  Pilot pilot(p);
  EXPECT_EQ(pilot.turns(10, kFast).reason, MotionReason::lowest);
  const MotionDecision d = pilot.turns(6, kSlow);
  EXPECT_EQ(d.reason, MotionReason::blur_stopped);
  EXPECT_EQ(d.blur, MotionBlur{});
}

TEST(HeadMotion, withoutRestorationNothingRaisesTheLevelAgain) {
  MotionParameters p;
  p.control = MotionControl::lod_scale_and_blur;
  Pilot pilot(p);
  pilot.turns(10, kFast);
  const MotionDecision d = pilot.turns(1000, kSlow);
  EXPECT_EQ(d.lodScale, 2);
  EXPECT_EQ(d.restoreStack, MotionStack{});
  EXPECT_EQ(d.restoreLimit, 0);
  EXPECT_EQ(d.blur, MotionBlur{}) << "the blur ends by its duration";
}

TEST(HeadMotion, offForgetsEverything) {
  Pilot pilot;
  pilot.turns(15, kFast);
  pilot.p.control = MotionControl::off;
  EXPECT_EQ(pilot.turn(kFast), MotionDecision{});
  EXPECT_EQ(pilot.memory, MotionMemory{});
}

TEST(HeadMotion, dwellsInMillisecondsAlikeAtAnyFrameRate) {
  for (const double fps : {25.0, 60.0, 100.0, 450.0}) {
    MotionParameters p;
    p.dwell = MotionDwell::milliseconds;
    Pilot pilot(p);
    int fast = 1, slow = 1;
    while (pilot.turn(kFast, 1 / fps).reason != MotionReason::lowered) ++fast;
    EXPECT_EQ(fast, std::ceil(0.1 * fps - 1e-6)) << fps << " fps: 100 ms or more";
    while (pilot.turn(kSlow, 1 / fps).reason != MotionReason::raised) ++slow;
    EXPECT_EQ(slow, std::floor(0.05 * fps + 1e-6) + 1) << fps << " fps: more than 50 ms";
  }
}

TEST(HeadMotion, blursForItsMillisecondsAtAnyFrameRate) {
  for (const double fps : {11.0, 60.0, 144.0, 450.0}) {
    MotionParameters p;
    p.control = MotionControl::lod_scale_and_blur;
    Pilot pilot(p);
    ASSERT_EQ(pilot.turns(10, kFast, 1 / fps).reason, MotionReason::lowered);
    int frames = 1;  // drawn with blur, the first included
    MotionDecision d;
    while ((d = pilot.turn(kSlow, 1 / fps)).blur.strength > 0) ++frames;
    EXPECT_EQ(d.reason, MotionReason::blur_ended);
    EXPECT_EQ(frames, std::ceil(0.4 * fps - 1e-6)) << fps << " fps";
  }
}

TEST(HeadMotion, emptiesBothStacksAcrossAGapAndKeepsTheLevel) {
  Pilot pilot;
  pilot.turns(10, kFast);
  pilot.turns(9, kFast);
  MotionDecision d = pilot.turn(kFast, 0.251);
  EXPECT_EQ(d.reason, MotionReason::gap);
  EXPECT_EQ(d.blurStack, MotionStack{});
  EXPECT_EQ(d.lodScale, 2);
  EXPECT_NEAR(d.blur.remainingMs, 400 - 90 - 251, 1e-6) << "its time goes on";
  EXPECT_EQ(pilot.turns(9, kFast).reason, MotionReason::fast);
  EXPECT_EQ(pilot.turn(kFast).reason, MotionReason::lowered);
  pilot.turns(5, kSlow);
  EXPECT_EQ(pilot.turn(kSlow, 1).restoreStack, MotionStack{});
  EXPECT_EQ(pilot.turns(5, kSlow).reason, MotionReason::slow);
  EXPECT_EQ(pilot.turn(kSlow).reason, MotionReason::raised);
  EXPECT_NE(pilot.turn(kSlow, 0.25).reason, MotionReason::gap) << "exactly the limit is no gap";
}

TEST(HeadMotion, startsOverWhenTheClockGoesBack) {
  Pilot pilot;
  pilot.turns(19, kFast);
  pilot.time = -5;
  const MotionDecision d = pilot.look();
  EXPECT_EQ(d.reason, MotionReason::time_back);
  EXPECT_EQ(d.lodScale, 1);
  EXPECT_EQ(d.blur, MotionBlur{});
  EXPECT_EQ(d.blurStack, MotionStack{});
  EXPECT_EQ(pilot.turns(9, kFast).reason, MotionReason::fast);
  EXPECT_EQ(pilot.turn(kFast).reason, MotionReason::lowered);
}

TEST(HeadMotion, countsATurnWithoutTimeInTheNextStep) {
  Pilot pilot;
  pilot.turns(5, kFast);
  const MotionMemory before = pilot.memory;
  pilot.heading += 0.5;
  EXPECT_EQ(pilot.look().reason, MotionReason::same_time);
  EXPECT_EQ(pilot.memory, before);
  EXPECT_NEAR(pilot.turn(0).rateDegPerS, 50, 1e-6);
}

TEST(HeadMotion, passesOverWhatIsNoNumber) {
  for (const double bad : {kNan, kInfinity, -kInfinity}) {
    Pilot pilot;
    pilot.turns(9, kFast);
    const MotionMemory before = pilot.memory;
    const auto poison = [&](double& value) {
      const double good = std::exchange(value, bad);
      const MotionDecision d = pilot.look();
      EXPECT_EQ(d.reason, MotionReason::invalid_input);
      EXPECT_EQ(d.blurStack.frames, 9u);
      EXPECT_EQ(pilot.memory, before);
      value = good;
    };
    poison(pilot.time);
    poison(pilot.heading);
    poison(pilot.pitch);
    EXPECT_EQ(pilot.turn(kFast).reason, MotionReason::lowered) << "as if it had not come";
    Pilot first;
    first.memory = {};
    first.heading = bad;
    EXPECT_EQ(first.look().reason, MotionReason::invalid_input);
    first.heading = 0;
    EXPECT_EQ(first.look().reason, MotionReason::first_frame);
  }
}

TEST(HeadMotion, followsASweepOfTenThousandDegreesASecond) {
  for (const double fps : {60.0, 200.0, 1000.0}) {
    Pilot pilot;
    EXPECT_EQ(pilot.turns(10, 10000, 1 / fps).reason, MotionReason::lowered) << fps;
    EXPECT_NEAR(pilot.turn(10000, 1 / fps).rateDegPerS, 10000, 1e-3) << fps;
  }
  // Half a turn between two states and more: the short way round, so never more than that.
  Pilot pilot;
  EXPECT_NEAR(pilot.turn(10000, 1.0 / 30).rateDegPerS, (360 - 10000.0 / 30) * 30, 1e-6);
}

TEST(HeadMotion, spellsEveryReasonItsOwnWay) {
  std::set<std::string_view> names;
  std::set<std::string> texts;
  for (int i = 0; i <= static_cast<int>(MotionReason::blur_ended); ++i) {
    MotionDecision d;
    d.reason = static_cast<MotionReason>(i);
    EXPECT_TRUE(names.insert(toText(d.reason)).second);
    EXPECT_TRUE(texts.insert(explain(d)).second);
  }
  EXPECT_EQ(toText(static_cast<MotionReason>(names.size())), "");
  Pilot pilot;
  EXPECT_EQ(explain(pilot.turns(10, kFast)),
            "fast for 10 frames (180.0 deg/s against 60.0): detail lowered, LOD scale 2, blur for 400 ms");
}

}  // namespace
}  // namespace trimtab
