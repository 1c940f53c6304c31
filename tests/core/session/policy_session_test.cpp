#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "tests/support.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/frame/ground_heights.h"
#include "trimtab/measure/trace.h"
#include "trimtab/session/session.h"

namespace trimtab {
namespace {

/// Level ground; counts how often it is asked.
class FlatGround : public GroundHeights {
 public:
  std::optional<Metres> heightAt(Degrees, Degrees) const override {
    ++asked;
    return Metres{200};
  }
  mutable int asked = 0;
};

ValidatedParameters with(const std::function<void(TuningParameters&)>& edit) {
  TuningParameters parameters;
  parameters.policy.enabled = true;
  edit(parameters);
  auto validated = validate(parameters);
  EXPECT_TRUE(validated) << toString(validated.findings());
  return validated.value();
}

ValidatedParameters lowAndLoaded() {
  return with([](TuningParameters& p) {
    p.policy.terms.line = {"above_ground low = ramp 2000 500", "load high = ramp 0.5 2",
                           "sight_rate fast = ramp 20 120"};
    p.policy.rules.line = {"if above_ground is low then screen_space_error = 8, far_distance = 0.5",
                           "if load is high then lod_scale = 4, render_scale = 0.5",
                           "if sight_rate is fast then particle_density = 0.25, blur_strength = 0.5"};
  });
}

AircraftState flownAt(double time, double heightM) {
  AircraftState state;
  state.time = time;
  state.packet = static_cast<std::uint64_t>(time * 60);
  state.position = {Degrees{36.6}, Degrees{128.3 + time * 1e-4}, Metres{heightM}};
  state.attitude = {Degrees{90 + 40 * std::sin(time)}, Degrees{0}, Degrees{0}};
  return state;
}

FrameResult resultCosting(double ms) {
  FrameResult result;
  result.cost.total = ms;
  result.visible.triangles = 5000;
  return result;
}

TEST(PolicySession, aCameraSetDownElsewhereHasNotTurnedOrFlownThere) {
  Session session(lowAndLoaded());
  session.watchSignals();
  for (int i = 0; i < 5; ++i) session.look(flownAt(1 + i / 60.0, 3000));
  const double turning = session.signalValues()[Signal::sight_rate];
  EXPECT_GT(turning, 1);
  EXPECT_LT(turning, 60);
  AircraftState home = flownAt(1 + 5 / 60.0, 3000);
  home.position.latitude = home.position.latitude + Degrees{0.5};
  home.attitude.heading = home.attitude.heading + Degrees{170};
  session.look(home);
  EXPECT_TRUE(std::isnan(session.signalValues()[Signal::sight_rate]));
  EXPECT_TRUE(std::isnan(session.signalValues()[Signal::speed]));
  home.time += 1 / 60.0;
  home.attitude.heading = home.attitude.heading + Degrees{0.5};
  session.look(home);
  EXPECT_NEAR(session.signalValues()[Signal::sight_rate], 30, 5);
}

TEST(PolicySession, setsWhatTheRequestAsksFor) {
  Session session(lowAndLoaded());
  const auto ground = std::make_shared<FlatGround>();
  session.setGround(ground);
  session.fly(flownAt(1, 300));
  EXPECT_GT(ground->asked, 0) << "a rule asks for the height above ground";
  const auto request = session.request(1, 640, 360);
  ASSERT_TRUE(request);
  EXPECT_DOUBLE_EQ(request->levers.drawn.errorPx, 8);
  EXPECT_DOUBLE_EQ(request->levers.drawn.treeErrorPx, 4) << "half of the others', as in the preset";
  EXPECT_DOUBLE_EQ(request->levers.drawn.lodScale, 1) << "the load is unknown before an image is finished";
  EXPECT_EQ(request->levers.drawn.renderScale, 1);
  EXPECT_TRUE(session.decision().policy.unknownAsked & 1u << indexOf(Signal::load));
  EXPECT_NE(explain(session.decision(), session.parameters()).find("Load unknown"), std::string::npos);
}

TEST(PolicySession, knowsTheHeightAboveGroundBeforeARuleAsksForIt) {
  Session session(with([](TuningParameters& p) {
    p.policy.terms.line = {"load high = ramp 0.5 2"};
    p.policy.rules.line = {"if load is high then lod_scale = 4"};
  }));
  const auto ground = std::make_shared<FlatGround>();
  session.setGround(ground);
  session.fly(flownAt(1, 300));
  EXPECT_EQ(ground->asked, 0) << "nobody needs the height";
  session.watchSignals();
  session.fly(flownAt(2, 300));
  EXPECT_DOUBLE_EQ(session.signalValues()[Signal::above_ground], Metres{100}.as<Feet>().value());
  EXPECT_FALSE(session.input().aboveGround) << "no decision depends on it";
}

TEST(PolicySession, withoutAPolicyNothingIsSetAndNothingIsAsked) {
  Session session(defaultParameters());
  const auto ground = std::make_shared<FlatGround>();
  session.setGround(ground);
  session.fly(flownAt(1, 300));
  const auto request = session.request(1, 640, 360);
  ASSERT_TRUE(request);
  EXPECT_EQ(request->levers.drawn.renderScale, 1);
  EXPECT_EQ(request->levers.drawn.particleShare, 1);
  EXPECT_EQ(request->decision.policy, PolicyOutcome{});
  EXPECT_EQ(ground->asked, 0);
  for (const double value : session.input().signalValues.value) EXPECT_TRUE(std::isnan(value));
}

TEST(PolicySession, whoWatchesSeesTheSignalsOfAPresetWithoutAPolicy) {
  Session session(defaultParameters());
  session.setGround(std::make_shared<FlatGround>());
  session.watchSignals();
  session.fly(flownAt(1, 300));
  EXPECT_DOUBLE_EQ(session.signalValues()[Signal::above_ground], Metres{100}.as<Feet>().value());
  for (const double value : session.input().signalValues.value)
    EXPECT_TRUE(std::isnan(value)) << "no decision and no trace depends on them";
  session.restart();
  session.fly(flownAt(2, 300));
  EXPECT_FALSE(std::isnan(session.signalValues()[Signal::altitude])) << "after a restart too";
  session.setParameters(lowAndLoaded());
  session.fly(flownAt(3, 300));
  EXPECT_EQ(session.signalValues()[Signal::altitude], session.input().signalValues[Signal::altitude]);
}

TEST(PolicySession, heavyFramesMoveTheLeversAndNoFasterThanTheirRates) {
  Session session(lowAndLoaded());
  double last = 1, lastScale = 1;
  for (int i = 1; i <= 120; ++i) {
    const double time = i / 60.0;
    session.fly(flownAt(time, 5000));
    const auto request = session.request(time, 640, 360);
    session.finished(resultCosting(i < 60 ? 50 : 5), time);
    const double scale = request->levers.drawn.lodScale;
    EXPECT_LE(std::abs(std::log2(scale / last)), rowOf(Lever::lod_scale).ratePerS / 60 + 1e-9) << i;
    EXPECT_LE(std::abs(request->levers.drawn.renderScale - lastScale),
              rowOf(Lever::render_scale).ratePerS / 60 + 1e-9);
    last = scale;
    lastScale = request->levers.drawn.renderScale;
    if (i == 59) {
      EXPECT_DOUBLE_EQ(scale, 4);
      EXPECT_DOUBLE_EQ(lastScale, 0.5);
    }
  }
  EXPECT_DOUBLE_EQ(last, 1) << "detail comes back after the load is gone";
  EXPECT_DOUBLE_EQ(lastScale, 1);
}

/// The load follows the lever that the load sets: half the picture's size takes a quarter of the time, so
/// that a steep rule asks for both sizes in turn. Work time has noise and spikes.
TEST(PolicySession, aLeverThatFollowsTheLoadComesToRestWithTheView) {
  const ValidatedParameters parameters = with([](TuningParameters& p) {
    p.policy.terms.line = {"load high = ramp 0.95 1.05"};
    p.policy.rules.line = {"if load is high then render_scale = 0.5, lod_scale = 4"};
  });
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0, 0.08);
  std::size_t moves = 0;
  for (const double fullMs : {9.0, 15.0, 17.0, 25.0, 40.0, 80.0}) {
    Session session(parameters);
    double scale = 1;
    int changedAt = 0;
    for (int i = 1; i <= 1200; ++i) {
      AircraftState state = flownAt(1, 5000);
      state.time = i / 60.0;
      session.fly(state);
      const auto request = session.request(state.time, 640, 360);
      moves += request->levers.drawn.renderScale != scale;
      if (request->levers.drawn.renderScale != scale) changedAt = i;
      scale = request->levers.drawn.renderScale;
      const double spike = random() % 40 == 0 ? 5 : 1;
      const double other = i > 600 ? 1.5 : 1;  // another program takes a part of the machine
      session.finished(
          resultCosting(fullMs * other * scale * scale * std::max(0.1, 1 + noise(random)) * spike),
          state.time);
      if (i == 600) {
        EXPECT_LT(changedAt, 400) << fullMs << " ms: the lever does not rest";
      }
    }
    EXPECT_LT(changedAt, 1000) << fullMs << " ms: the lever does not rest after the load has changed";
    if (fullMs > 20) {
      EXPECT_LT(scale, 0.8) << fullMs;
    }
    if (fullMs < 10) {
      EXPECT_EQ(scale, 1) << fullMs;
    }
  }
  EXPECT_GT(moves, 50u);
}

/// Measured load and all: a trace holds what the policy was given.
TEST(PolicySession, aTraceIsDecidedAgainToTheBit) {
  const ValidatedParameters parameters = lowAndLoaded();
  Session session(parameters);
  session.setGround(std::make_shared<FlatGround>());
  session.keepRows(true);
  for (int i = 1; i <= 400; ++i) {
    const double time = i / 60.0;
    session.fly(flownAt(time, 900 + 700 * std::sin(time)));
    session.request(time, 640, 360);
    session.finished(resultCosting(10 + 20 * std::sin(i * 0.7) * std::sin(i * 0.01)), time);
  }
  std::vector<TraceRow> rows;
  session.takeRows(rows, true);
  std::string text = traceHeader() + "\n";
  for (const TraceRow& row : rows) appendTraceRow(text, row);
  const auto read = parseTrace(text, "trace");
  ASSERT_TRUE(read) << toString(read.findings());
  EXPECT_TRUE(decideAgain(*read, parameters).empty());

  Session replay(parameters);
  std::size_t moved = 0;
  for (const TraceRow& row : *read) {
    replay.replay(row);
    ASSERT_EQ(replay.decision(), row.decision) << row.input.state.packet;
    moved += row.levers.policy.lodScale != 1;
  }
  EXPECT_GT(moved, 100u) << "the load must move a lever, or nothing is shown";
}

/// Signals that are not numbers fire nothing, and the levers stay where their neutral values are.
TEST(PolicySession, survivesWhatHostsSend) {
  Session session(lowAndLoaded());
  const double bad[] = {std::nan(""), HUGE_VAL, -HUGE_VAL, 1e300, -1e300, 0};
  double time = 0;
  for (const double value : bad)
    for (int field = 0; field < 6; ++field) {
      AircraftState state = flownAt(time += 0.016, 5000);
      switch (field) {
        case 0:
          state.position.height = Metres{value};
          break;
        case 1:
          state.attitude.pitch = Degrees{value};
          break;
        case 2:
          state.attitude.roll = Degrees{value};
          break;
        case 3:
          state.attitude.heading = Degrees{value};
          break;
        case 4:
          state.airspeed = Knots{value};
          break;
        default:
          state.velocity = Velocity{MetresPerSecond{value}, MetresPerSecond{value}, MetresPerSecond{value}};
      }
      session.fly(state);
      for (const LeverRow& row : kLeverRows) {
        const double set = session.decision().policy[row.lever];
        EXPECT_TRUE(set >= row.hard.low && set <= row.hard.high) << row.key << " " << set;
      }
    }
}

}  // namespace
}  // namespace trimtab
