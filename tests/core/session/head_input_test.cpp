#include "trimtab/session/head_input.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support.h"
#include "trimtab/host/received_state.h"
#include "trimtab/motion/head_motion.h"
#include "trimtab/session/session.h"
#include "trimtab/units/not_finite.h"

namespace trimtab {
namespace {

AircraftState level(double time) {
  AircraftState state;
  state.time = time;
  state.packet = static_cast<std::uint64_t>(std::lround(time * 60)) + 1;
  state.position = {Degrees{36.6}, Degrees{128.3}, Metres{1500}};
  return state;
}

HeadLog sweep(const char* text = "sweep:180/1s") {
  return parseSweep(text).value();
}

/// Decides every row of the trace again, after it has been text, and by a session that knows of no head
/// input.
void expectReplaysToTheBit(const std::vector<TraceRow>& rows) {
  std::string text = traceHeader() + '\n';
  for (const TraceRow& row : rows) appendTraceRow(text, row);
  const Result<std::vector<TraceRow>> read = parseTrace(text, "trace");
  ASSERT_TRUE(read.ok()) << toString(read.findings());
  EXPECT_TRUE(decideAgain(*read, defaultParameters()).empty());
  Session replayed(defaultParameters());
  for (const TraceRow& row : *read) {
    replayed.replay(row);
    ASSERT_EQ(replayed.decision(), row.decision);
  }
}

TEST(HeadInput, leavesTheHostsHeadAloneUnlessTold) {
  Session session(defaultParameters());
  AircraftState state = level(0);
  state.head = Attitude{Degrees{5}, Degrees{6}, Degrees{7}};
  session.fly(state);
  EXPECT_EQ(session.input().state.head, state.head);
  session.head().useNone();
  session.fly(state);
  EXPECT_FALSE(session.input().state.head);
}

TEST(HeadInput, playsALogOnTheStatesClockFromTheFirstOne) {
  Session session(defaultParameters());
  const HeadLog log = sweep();
  session.head().useLog(log);
  for (int i = 0; i < 600; ++i) {
    session.fly(level(5000 + i / 60.0));
    EXPECT_EQ(session.input().state.head, headAt(log, (5000 + i / 60.0) - 5000)) << i;
  }
  EXPECT_NEAR(session.head().logTime(5009), 9, 1e-9);
  session.restart();
  session.fly(level(70));
  EXPECT_EQ(session.input().state.head->heading, Degrees{-90}) << "begins again with the flight";
  session.head().begin(68);
  session.fly(level(70.5));
  EXPECT_NEAR(session.input().state.head->heading.value(), 0, 1e-9) << "half the sweep";
}

TEST(HeadInput, aSweepOf180DegreesInASecondLowersAndRaisesTheLevels) {
  Session session(defaultParameters());
  session.keepRows(true);
  session.head().useLog(sweep());
  for (int i = 0; i < 60 * 6; ++i) session.fly(level(i / 60.0));
  std::vector<TraceRow> rows;
  session.takeRows(rows, true);
  int lowered = 0, raised = 0;
  double largest = 1;
  for (const TraceRow& row : rows) {
    lowered += row.decision.motion.reason == MotionReason::lowered;
    raised += row.decision.motion.reason == MotionReason::raised;
    largest = std::max(largest, row.levers.drawn.lodScale);
    if (row.input.state.time < 2 + 9.5 / 60) {
      EXPECT_EQ(row.levers.drawn.lodScale, 1) << row.input.state.time;
    }
  }
  EXPECT_EQ(lowered, 4) << "two levels each way";
  EXPECT_EQ(raised, 2) << "after the way there; the way back ends with the last state";
  EXPECT_EQ(largest, 4);
  expectReplaysToTheBit(rows);
}

TEST(HeadInput, multipliesThePresetsLodScaleOnce) {
  TuningParameters parameters;
  parameters.lod.scale = Ratio{1.5};
  Session session(validate(parameters).value());
  session.head().useLog(sweep());
  for (int i = 0; i < 132; ++i) session.fly(level(i / 60.0));
  ASSERT_EQ(session.decision().motion.lodScale, 2);
  EXPECT_EQ(leversOf(session.decision(), *session.parameters()).drawn.lodScale, 3);
  EXPECT_EQ(session.request(0, 640, 480)->levers.drawn.lodScale, 3);
}

TEST(HeadInput, replaysARecordedLogToTheBit) {
  TRIMTAB_NEEDS_SHARED("data/headmotion-mv360/user2_euler.txt");
  const auto log = readHeadLog(test::sharedDir() / "data/headmotion-mv360/user2_euler.txt");
  ASSERT_TRUE(log.ok());
  Session session(defaultParameters());
  session.keepRows(true);
  session.head().useLog(*log);
  for (int i = 0; i < 60 * 100; ++i) {
    AircraftState state = level(i / 60.0);
    state.attitude = {Degrees{std::fmod(i * 0.05, 360)}, Degrees{3 * std::sin(i * 0.01)},
                      Degrees{25 * std::sin(i * 0.003)}};
    session.fly(state);
  }
  std::vector<TraceRow> rows;
  session.takeRows(rows, true);
  int lowered = 0;
  for (const TraceRow& row : rows) lowered += row.decision.motion.reason == MotionReason::lowered;
  EXPECT_GT(lowered, 10);
  expectReplaysToTheBit(rows);
}

TEST(HeadInput, thePointersPlaceIsTheLineOfSight) {
  HeadInput input;
  input.usePointer();
  AircraftState state = level(0);
  input.apply(state, 10);
  EXPECT_EQ(state.head, Attitude{}) << "straight ahead before the first event";
  input.point(1, -1, 20);
  input.applyToEye(state);
  EXPECT_EQ(state.head, (Attitude{Degrees{90}, Degrees{-45}, Degrees{0}}));
  input.point(-7, 0.5, 21);
  input.applyToEye(state);
  EXPECT_EQ(state.head, (Attitude{Degrees{-90}, Degrees{22.5}, Degrees{0}})) << "beyond is the edge";
  input.point(kNan, kNan, 22);
  input.applyToEye(state);
  EXPECT_EQ(state.head, Attitude{});
  input.point(0.5, 0, 21.5);
  input.applyToEye(state);
  EXPECT_EQ(state.head, Attitude{}) << "an event from before changes nothing";
}

TEST(HeadInput, pointerEventsOfAnyRateGiveStatesASteadyMotion) {
  for (const double eventHz : {12.0, 20.0, 60.0, 125.0}) {
    Session session(defaultParameters());
    session.head().usePointer();
    // Rest, then from one edge to the other in a second: 180 degrees.
    const double start = 100, end = 101;
    double nextEvent = start;
    session.head().point(-1, 0, start - 5);
    int longestRun = 0, run = 0;
    for (int i = 0; i < 90; ++i) {
      const double now = start + i / 60.0;
      for (; nextEvent <= now && nextEvent <= end; nextEvent += 1 / eventHz)
        session.head().point(-1 + 2 * (nextEvent - start), 0, nextEvent);
      const AircraftState state = level(now - start);
      const ReceivedState packet{state, now, now};
      session.receive({&packet, 1});
      run = session.decision().motion.fast ? run + 1 : 0;
      longestRun = std::max(longestRun, run);
    }
    EXPECT_GE(longestRun, 50) << eventHz << " events a second";
    EXPECT_NEAR(session.eyeState(end).head->heading.value(), 90, 16) << "the eye is there";
  }
}

TEST(HeadInput, movesUntilALogIsOverOrThePointerRests) {
  HeadInput input;
  EXPECT_FALSE(input.moves(0));
  HeadLog log;
  log.samples = {{0, 0, 0, 0}, {10, 40, 0, 0}};
  input.useLog(log);
  EXPECT_TRUE(input.moves(0));
  AircraftState state = level(50);
  input.apply(state, 50);
  EXPECT_TRUE(input.moves(59));
  EXPECT_FALSE(input.moves(62));
  input.useLog(sweep());
  input.apply(state, 50);
  EXPECT_TRUE(input.moves(1e6)) << "a sweep goes on";
  input.usePointer();
  EXPECT_FALSE(input.moves(0));
  input.point(0, 0, 100);
  EXPECT_TRUE(input.moves(101));
  EXPECT_FALSE(input.moves(102));
}

TEST(Session, countsABlurDownBetweenPacketsAndAsksForPicturesUntilItIsGone) {
  TuningParameters parameters;
  parameters.host.extrapolate = false;
  Session session(validate(parameters).value());
  session.head().useLog(sweep());
  const double offset = 1000;
  for (int i = 0; i < 132; ++i) {
    const ReceivedState packet{level(i / 60.0), offset + i / 60.0, offset + i / 60.0};
    session.receive({&packet, 1});
  }
  const double blurMs = session.decision().motion.blur.remainingMs;
  ASSERT_GT(blurMs, 100);
  const double first = offset + 2.2;
  const auto drawn = [&](double now) { return session.request(now, 640, 480)->decision.motion.blur; };
  EXPECT_EQ(drawn(first).remainingMs, blurMs) << "from its first picture on";
  EXPECT_TRUE(session.needsImage(first)) << "the host is silent, but the blur is not over";
  EXPECT_NEAR(drawn(first + 0.05).remainingMs, blurMs - 50, 1e-6);
  EXPECT_TRUE(session.needsImage(first + 0.06));
  EXPECT_EQ(drawn(first + blurMs * 1e-3 + 0.001), MotionBlur{});
  EXPECT_FALSE(session.needsImage(first + 1));
  EXPECT_EQ(session.decision().motion.blur.remainingMs, blurMs) << "what was decided stays as it was decided";
}

}  // namespace
}  // namespace trimtab
