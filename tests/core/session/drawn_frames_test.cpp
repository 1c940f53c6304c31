#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/support.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/host/received_state.h"
#include "trimtab/motion/head_motion.h"
#include "trimtab/session/image_rate.h"
#include "trimtab/session/session.h"

/// Head motion that counts images (MotionFrames::drawn), over hosts of any rate.
namespace trimtab {
namespace {

constexpr double kImagesPerS = 60, kOffset = 1000;
constexpr double kSweepFrom = 1, kSweepTo = 2;  // seconds; 180 degrees between them

ValidatedParameters reading(MotionFrames frames, const std::function<void(TuningParameters&)>& edit = {}) {
  TuningParameters parameters;
  parameters.motion.frames = frames;
  if (edit) edit(parameters);
  return validate(parameters).value();
}

AircraftState headAt(double time) {
  AircraftState state;
  state.time = time;
  state.position = {Degrees{36.6}, Degrees{128.3}, Metres{1500}};
  const double part = std::clamp((time - kSweepFrom) / (kSweepTo - kSweepFrom), 0.0, 1.0);
  state.head = Attitude{Degrees{-90 + 180 * part}, {}, {}};
  return state;
}

struct Image {
  double time = 0;
  MotionDecision motion;
};

/// Draws five seconds of images of a host that sends so many states a second. The host falls silent at
/// `silentAt`.
std::vector<Image> fly(Session& session, double statesPerS, double silentAt = 5) {
  std::vector<Image> images;
  double nextState = 0;
  for (int i = 0; i < 5 * kImagesPerS; ++i) {
    const double time = i / kImagesPerS;
    for (; nextState <= time && nextState < silentAt; nextState += 1 / statesPerS) {
      const double arrival = nextState + kOffset;
      session.receive(std::vector{ReceivedState{headAt(nextState), arrival, arrival}});
    }
    if (!session.needsImage(time + kOffset)) continue;
    const auto request = session.request(time + kOffset, 640, 480);
    images.push_back({time, request->decision.motion});
    FrameResult result;
    result.visible.vertices = 30000;
    session.finished(result, time + kOffset + 0.001);
  }
  return images;
}

double firstCoarse(const std::vector<Image>& images) {
  for (const Image& image : images)
    if (image.motion.level > 0) return image.time;
  return 1e9;
}
double lastCoarse(const std::vector<Image>& images) {
  double last = -1;
  for (const Image& image : images)
    if (image.motion.level > 0) last = image.time;
  return last;
}
double lastBlurred(const std::vector<Image>& images) {
  double last = -1;
  for (const Image& image : images)
    if (image.motion.blur.strength > 0) last = image.time;
  return last;
}

TEST(DrawnFrames, aSweepIsMetEarlyAndARestingHeadIsNeverBlurredAtAnyHostRate) {
  for (const double hostRate : {10.0, 30.0, 60.0, 200.0}) {
    Session session(reading(MotionFrames::drawn));
    const std::vector<Image> images = fly(session, hostRate);
    // Ten images are 0.17 s; a slow host's turn is seen only with its second state.
    EXPECT_LT(firstCoarse(images), kSweepFrom + 0.17 + 2 / hostRate + 0.05) << hostRate;
    // Six images restore one level of two, and a slow host's rest is seen with its next state.
    EXPECT_LT(lastBlurred(images), kSweepTo + 0.1 + 2 / hostRate + 0.05) << hostRate;
    EXPECT_LT(lastCoarse(images), kSweepTo + 0.2 + 2 / hostRate + 0.05) << hostRate;
    EXPECT_GT(lastCoarse(images), kSweepTo - 0.1) << hostRate;
  }
}

TEST(DrawnFrames, statesOfAHostOf10HzFillTheStackOnlyWhenTheSweepIsOver) {
  Session session(reading(MotionFrames::host_states));
  const std::vector<Image> images = fly(session, 10);
  EXPECT_GT(firstCoarse(images), kSweepTo - 0.11) << "the reason why images are counted";
  EXPECT_GT(lastBlurred(images), kSweepTo + 0.2);
}

TEST(DrawnFrames, withoutExtrapolationAStandingPictureIsASlowFrame) {
  Session session(reading(MotionFrames::drawn, [](TuningParameters& p) { p.host.extrapolate = false; }));
  EXPECT_EQ(lastBlurred(fly(session, 10)), -1) << "five of six images of a host of 10 Hz do not move";
}

TEST(DrawnFrames, restoreEvenIfTheHostFallsSilentInTheSweep) {
  Session session(reading(MotionFrames::drawn));
  const std::vector<Image> images = fly(session, 60, 1.8);
  EXPECT_GT(lastCoarse(images), 1.5);
  EXPECT_LT(images.back().time, 4.9) << "images end once detail is restored";
  EXPECT_EQ(images.back().motion.level, 0u);
  EXPECT_FALSE(session.unsettled());
}

TEST(DrawnFrames, theLoadDecidesWhetherDetailIsLowered) {
  const auto coarse = [](const std::function<void(TuningParameters&)>& edit) {
    Session session(reading(MotionFrames::drawn, edit));
    const std::vector<Image> images = fly(session, 60);
    EXPECT_GT(lastBlurred(images), kSweepFrom) << "the blur does not depend on the load";
    return lastCoarse(images) > 0;
  };
  EXPECT_TRUE(coarse([](TuningParameters& p) { p.motion.lodOverTime = Milliseconds{16}; }));
  EXPECT_FALSE(coarse([](TuningParameters& p) { p.motion.lodOverTime = Milliseconds{17}; }));
  EXPECT_TRUE(coarse([](TuningParameters& p) { p.motion.lodOverVertices = Ratio{29999}; }));
  EXPECT_FALSE(coarse([](TuningParameters& p) { p.motion.lodOverVertices = Ratio{30000}; }));
  EXPECT_FALSE(coarse([](TuningParameters& p) {
    p.motion.lodOverTime = Milliseconds{16};
    p.motion.lodOverVertices = Ratio{30000};
  })) << "fewer vertices do not help a frame that is slow for another reason";
}

TEST(DrawnFrames, aTraceHoldsARowForEachImageAndReplaysToTheBit) {
  const ValidatedParameters parameters =
      reading(MotionFrames::drawn, [](TuningParameters& p) { p.motion.lodOverVertices = Ratio{29999}; });
  Session session(parameters);
  session.keepRows(true);
  const std::size_t images = fly(session, 30).size();
  std::vector<TraceRow> rows;
  session.takeRows(rows, true);
  ASSERT_EQ(rows.size(), images);
  EXPECT_EQ(session.packets(), 150u);
  EXPECT_TRUE(rows[100].input.drawn.framesPerS && rows[100].input.drawn.vertices && rows[100].frame);
  EXPECT_NEAR(*rows[100].input.drawn.framesPerS, kImagesPerS, 1e-6);

  std::size_t between = 0;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const FrameInput &before = rows[i - 1].input, &now = rows[i].input;
    ASSERT_TRUE(now.drawn.eye);
    if (now.state.time != before.state.time) continue;
    ASSERT_TRUE(now.state == before.state) << "one packet, one state";
    between += now.drawn.eye != before.drawn.eye;
  }
  EXPECT_GT(between, 20u) << "images between two states look elsewhere";

  std::string text = traceHeader() + '\n';
  for (const TraceRow& row : rows) appendTraceRow(text, row);
  const auto read = parseTrace(text, "trace");
  ASSERT_TRUE(read) << toString(read.findings());
  EXPECT_TRUE(decideAgain(*read, parameters).empty());
  Session replayed(parameters);
  int lowered = 0;
  for (const TraceRow& row : *read) {
    replayed.replay(row);
    ASSERT_EQ(replayed.decision(), row.decision);
    lowered += row.decision.motion.reason == MotionReason::lowered;
  }
  EXPECT_EQ(lowered, 2);
}

TEST(DrawnFrames, decideWithoutAWindowThatShowsThem) {
  Session session(reading(MotionFrames::drawn));
  AircraftState state = headAt(0);
  state.attitude.pitch = Degrees{20};
  session.receive(std::vector{ReceivedState{state, kOffset, kOffset}});
  EXPECT_EQ(session.decision().pitchDeg, 0) << "no image has asked";
  session.noPicture();
  EXPECT_EQ(session.decision().pitchDeg, 20);
}

TEST(ImageRate, isTheAverageOfRecentImagesAndBeginsAnewAfterAPause) {
  ImageRate rate;
  EXPECT_FALSE(rate.perS());
  rate.add(10);
  EXPECT_FALSE(rate.perS());
  for (int i = 1; i <= 100; ++i) rate.add(10 + i * 0.01);
  EXPECT_NEAR(*rate.perS(), 100, 1e-9);
  rate.add(11.05);
  EXPECT_NEAR(*rate.perS(), 21 / 0.25, 1e-6) << "one slow image in a quarter of a second";
  for (int i = 1; i <= 1000; ++i) rate.add(11.05 + i * 1e-4);
  EXPECT_NEAR(*rate.perS(), 1e4, 1) << "more images than it holds";
  rate.add(11.6);
  EXPECT_FALSE(rate.perS()) << "a pause";
  rate.add(11.5);
  EXPECT_FALSE(rate.perS()) << "the clock went back";
  rate.add(std::nan(""));
  EXPECT_FALSE(rate.perS());
  rate.add(11.6);
  EXPECT_FALSE(rate.perS());
  rate.add(11.65);
  EXPECT_NEAR(*rate.perS(), 20, 1e-9);
}

}  // namespace
}  // namespace trimtab
