#include <gtest/gtest.h>

#include <cmath>

#include "tests/support.h"
#include "trimtab/host/head_log.h"
#include "trimtab/motion/head_motion.h"

namespace trimtab {
namespace {

struct Watched {
  int runs = 0;  ///< of ten or more fast frames
  int lowered = 0, raised = 0, gaps = 0, stacksAtGap = 0;
  double largestScale = 1, fastestDegPerS = 0, finalScale = 1;
};

/// Each sample as a state of its own, at its own time.
Watched watch(const HeadLog& log, MotionParameters p) {
  Watched seen;
  MotionMemory memory;
  int run = 0;
  for (const HeadSample& sample : log.samples) {
    AircraftState state;
    state.time = sample.timeS;
    state.head = headAt(log, sample.timeS);
    const MotionDecision d = decideMotion(state, p, memory);
    run = d.fast ? run + 1 : 0;
    seen.runs += run == 10;
    seen.lowered += d.reason == MotionReason::lowered;
    seen.raised += d.reason == MotionReason::raised;
    seen.gaps += d.reason == MotionReason::gap;
    if (d.reason == MotionReason::gap) seen.stacksAtGap += d.blurStack.frames + d.restoreStack.frames > 0;
    seen.largestScale = std::max(seen.largestScale, d.lodScale);
    seen.fastestDegPerS = std::max(seen.fastestDegPerS, d.rateDegPerS);
    seen.finalScale = d.lodScale;
  }
  return seen;
}

TEST(HeadRecordings, haveTheKnownNumberOfFastRuns) {
  for (const char* name : {"user1_euler.txt", "user2_euler.txt"}) {
    TRIMTAB_NEEDS_SHARED(std::string("data/headmotion-mv360/") + name);
    const Result<HeadLog> log = readHeadLog(test::sharedDir() / "data/headmotion-mv360" / name);
    ASSERT_TRUE(log.ok()) << toString(log.findings());
    MotionParameters p;
    p.reference = MotionReference::head;
    const Watched seen = watch(*log, p);
    RecordProperty(std::string(name) + " runs", seen.runs);
    std::printf("%s: %zu samples, %.1f s, %d runs, %d lowered, %d raised, %d gaps, %.0f deg/s at most\n",
                name, log->samples.size(), log->durationS(), seen.runs, seen.lowered, seen.raised, seen.gaps,
                seen.fastestDegPerS);
    EXPECT_GE(seen.runs, 80) << name;
    EXPECT_LE(seen.runs, 100) << name;
    EXPECT_GE(seen.lowered, 40) << name;
    EXPECT_EQ(seen.largestScale, 4) << name;
    EXPECT_EQ(seen.finalScale, 1) << name << ": and comes to rest again";
    EXPECT_EQ(seen.stacksAtGap, 0) << name;
  }
}

TEST(HeadRecordings, haveGapsThatALowerLimitFinds) {
  TRIMTAB_NEEDS_SHARED("data/headmotion-mv360/user1_euler.txt");
  const Result<HeadLog> log = readHeadLog(test::sharedDir() / "data/headmotion-mv360/user1_euler.txt");
  ASSERT_TRUE(log.ok());
  MotionParameters p;
  p.gap = Milliseconds{50};
  const Watched seen = watch(*log, p);
  int longSteps = 0;
  for (std::size_t i = 1; i < log->samples.size(); ++i)
    longSteps += log->samples[i].timeS - log->samples[i - 1].timeS > 0.05;
  EXPECT_GT(longSteps, 0);
  EXPECT_EQ(seen.gaps, longSteps);
  EXPECT_EQ(seen.stacksAtGap, 0);
}

}  // namespace
}  // namespace trimtab
