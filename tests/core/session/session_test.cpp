#include "trimtab/session/session.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/host/received_state.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "tests/support.h"
#include "trimtab/frame/ground_heights.h"
#include "trimtab/units/not_finite.h"

namespace trimtab {
namespace {

/// Flat ground at a height; counts how often it is asked.
class FlatGround : public GroundHeights {
 public:
  explicit FlatGround(std::optional<double> heightM) : heightM_(heightM) {}
  std::optional<Metres> heightAt(Degrees, Degrees) const override {
    ++asked;
    return heightM_ ? std::optional(Metres{*heightM_}) : std::nullopt;
  }
  mutable int asked = 0;

 private:
  std::optional<double> heightM_;
};

AircraftState stateAt(double time, double altitudeFt, double pitchDeg) {
  AircraftState state;
  state.time = time;
  state.packet = static_cast<std::uint64_t>(time * 60);
  state.position = {Degrees{36.6}, Degrees{128.3 + time * 1e-4}, Feet{altitudeFt}.as<Metres>()};
  state.attitude = {Degrees{90}, Degrees{pitchDeg}, Degrees{0}};
  return state;
}

/// As a receiver hands it over: host time and arrival differ by a constant.
ReceivedState packet(const AircraftState& state, double arrivalOffset = 1000) {
  const double arrival = state.time + arrivalOffset;
  return {state, arrival, arrival + 1e-4};
}

/// Up and down through every band, with enough jitter to rest on the edges.
std::vector<AircraftState> wanderingStates(int count) {
  std::mt19937 random(7);
  std::normal_distribution<double> jitter(0, 1);
  std::vector<AircraftState> states;
  for (int i = 0; i < count; ++i)
    states.push_back(stateAt(i / 60.0, 6000 + 3500 * std::sin(i * 0.01) + 40 * jitter(random),
                             12 * std::sin(i * 0.037) + jitter(random)));
  return states;
}

ValidatedParameters with(const std::function<void(TuningParameters&)>& edit) {
  TuningParameters parameters;
  edit(parameters);
  return validate(parameters).value();
}

FrameResult resultCosting(double ms) {
  FrameResult result;
  result.cost.total = ms;
  result.visible.triangles = 77;
  return result;
}

TEST(Session, decidesOnceForEachPacketInOrderWithOneMemory) {
  const ValidatedParameters parameters = defaultParameters();
  Session session(parameters);
  session.keepRows(true);
  const std::vector<AircraftState> states = wanderingStates(2000);
  std::vector<ReceivedState> batch;
  for (std::size_t i = 0; i < states.size(); ++i) {
    batch.push_back(packet(states[i]));
    if (i % 7 != 0) continue;
    session.receive(batch);
    batch.clear();
  }
  session.receive(batch);
  std::vector<TraceRow> rows;
  session.takeRows(rows, true);

  ASSERT_EQ(rows.size(), states.size());
  DecisionMemory memory;
  int held = 0;
  for (std::size_t i = 0; i < states.size(); ++i) {
    EXPECT_EQ(rows[i].input.state, states[i]);
    EXPECT_EQ(rows[i].before, memory);
    ASSERT_EQ(rows[i].decision, decide({states[i], std::nullopt, {}, {}, {}}, parameters, memory)) << i;
    held += rows[i].decision.reason == SchemeReason::held_by_hysteresis;
  }
  EXPECT_GT(held, 0) << "the states must meet hysteresis, or order would not matter";
}

TEST(Session, anEditHoldsAtOnceForThePictureAndFromTheNextPacketOnForTheTrace) {
  Session session(with([](TuningParameters& p) { p.scheme.hysteresis = Membership{0}; }));
  session.keepRows(true);
  const AircraftState state = stateAt(1, 5000, 0);
  session.receive(std::vector{packet(state)});
  EXPECT_DOUBLE_EQ(session.decision().totalMembership, 0.6 + 0.5);
  session.setParameters(with([](TuningParameters& p) {
    p.scheme.hysteresis = Membership{0};
    p.altitude.curve.point[1].y = 0.35;
  }));
  EXPECT_DOUBLE_EQ(session.decision().totalMembership, 0.35 + 0.5);
  EXPECT_TRUE(session.needsImage(1001));
  EXPECT_EQ(session.packets(), 1u);
  EXPECT_EQ(session.memory().band, 2) << "of the packet, not of the edit";
  session.receive(std::vector{packet(stateAt(2, 5000, 0))});
  std::vector<TraceRow> rows;
  session.takeRows(rows, true);
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_DOUBLE_EQ(rows[0].decision.totalMembership, 1.1);
  EXPECT_DOUBLE_EQ(rows[1].decision.totalMembership, 0.85);
}

TEST(Session, asksTheTerrainWhereTheDecisionWantsItAndTheHostWhereTheTerrainKnowsNothing) {
  const auto aboveGround =
      with([](TuningParameters& p) { p.altitude.reference = AltitudeReference::above_ground; });
  struct Case {
    const char* name;
    ValidatedParameters parameters;
    std::optional<double> hostM, groundM, usedM;
    int asked;
  };
  const Case cases[] = {
      {"sea level wants no ground", defaultParameters(), {}, 300, {}, 0},
      {"both tell", aboveGround, 720, 300, 1000 - 300, 1},
      {"the host alone tells", aboveGround, 720, {}, 720, 1},
      {"the terrain tells", aboveGround, {}, 300, 1000 - 300, 1},
      {"nobody knows", aboveGround, {}, {}, {}, 1},
  };
  for (const Case& c : cases) {
    auto ground = std::make_shared<FlatGround>(c.groundM);
    Session session(c.parameters);
    session.setGround(ground);
    AircraftState state = stateAt(1, 0, 0);
    state.position.height = Metres{1000};
    if (c.hostM) state.aboveGround = Metres{*c.hostM};
    session.receive(std::vector{packet(state)});
    EXPECT_EQ(ground->asked, c.asked) << c.name;
    ASSERT_EQ(session.input().aboveGround.has_value(), c.usedM.has_value()) << c.name;
    if (c.usedM) {
      EXPECT_DOUBLE_EQ(session.input().aboveGround->value(), *c.usedM) << c.name;
    }
  }
}

TEST(Session, aTraceCutAnywhereReplaysToTheBitOverAnotherTerrain) {
  const auto parameters =
      with([](TuningParameters& p) { p.altitude.reference = AltitudeReference::above_ground; });
  Session recorded(parameters);
  recorded.setGround(std::make_shared<FlatGround>(123.456));
  recorded.keepRows(true);
  for (const AircraftState& state : wanderingStates(1500)) recorded.receive(std::vector{packet(state)});
  std::vector<TraceRow> rows;
  recorded.takeRows(rows, true);

  // The hard places to begin are rows that hysteresis held: without its memory they come out differently.
  int cuts = 0;
  for (std::size_t cut = 0; cut < rows.size() && cuts < 5; ++cut) {
    if (rows[cut].decision.reason != SchemeReason::held_by_hysteresis) continue;
    ++cuts;
    std::string text = traceHeader() + "\n";
    for (std::size_t i = cut; i < rows.size(); ++i) appendTraceRow(text, rows[i]);
    const Result<std::vector<TraceRow>> read = parseTrace(text, "trace");
    ASSERT_TRUE(read) << toString(read.findings());
    Session replayed(parameters);
    replayed.setGround(std::make_shared<FlatGround>(2000));
    for (std::size_t i = 0; i < read->size(); ++i) {
      replayed.replay((*read)[i]);
      ASSERT_EQ(replayed.decision(), rows[cut + i].decision) << i;
      ASSERT_EQ(replayed.input().state.position, rows[cut + i].input.state.position) << i;
    }
  }
  EXPECT_EQ(cuts, 5);
}

TEST(Session, aHeightNobodyKnewStaysUnknownOnReplay) {
  const auto parameters =
      with([](TuningParameters& p) { p.altitude.reference = AltitudeReference::above_ground; });
  Session recorded(parameters);
  recorded.keepRows(true);
  recorded.receive(std::vector{packet(stateAt(1, 5000, 0))});
  std::vector<TraceRow> rows;
  recorded.takeRows(rows, true);
  Session replayed(parameters);
  replayed.setGround(std::make_shared<FlatGround>(10));
  replayed.replay(rows[0]);
  EXPECT_EQ(replayed.decision(), rows[0].decision);
  EXPECT_EQ(replayed.decision().reason, SchemeReason::altitude_unknown);
}

TEST(Session, believesAHostThatPromisesADeadReckoningForItsWholeHeartbeat) {
  Session session(defaultParameters());  // silent after 500 ms
  AircraftState promised = stateAt(1, 5000, 0);
  promised.deadReckoning = DeadReckoning{};
  session.receive(std::vector{packet(promised)});
  EXPECT_EQ(session.linkState(1012.9), LinkState::live) << "11.9 s later: DIS gives a host up after 12";
  EXPECT_EQ(session.linkState(1013.1), LinkState::silent);
  // So six seconds without a packet are no silence, after which 3 km would be a jump.
  AircraftState far = promised;
  far.time = 7;
  far.position.latitude = Degrees{far.position.latitude.value() + 0.027};
  session.receive(std::vector{packet(far)});
  EXPECT_EQ(session.jumps(), 0U);
}

TEST(Session, tellsWhetherTheHostIsThere) {
  Session session(defaultParameters());  // silent after 500 ms
  EXPECT_EQ(session.linkState(5), LinkState::never);
  EXPECT_TRUE(std::isnan(session.packetAge(5)));
  session.receive(std::vector{packet(stateAt(1, 5000, 0))});
  EXPECT_EQ(session.linkState(1001.4), LinkState::live);
  EXPECT_NEAR(session.packetAge(1001.4), 0.4, 1e-9);
  EXPECT_EQ(session.linkState(1001.6), LinkState::silent);

  AircraftState far = stateAt(1.02, 5000, 0);
  far.position.latitude = Degrees{37.6};
  session.receive(std::vector{packet(far)});
  EXPECT_EQ(session.jumps(), 1u);
  EXPECT_EQ(session.linkState(1001.1), LinkState::jumped);
  far.time = 2.5;
  session.receive(std::vector{packet(far)});
  EXPECT_EQ(session.jumps(), 1u);
  EXPECT_EQ(session.linkState(1002.6), LinkState::live);
}

TEST(Session, theEyeMovesOnBetweenPacketsAndTheDecisionDoesNot) {
  Session session(defaultParameters());
  for (int i = 0; i <= 60; ++i) session.receive(std::vector{packet(stateAt(i / 60.0, 5000, 0))});
  const FrameDecision decision = session.decision();
  const double last = 1001;  // arrival of the newest packet
  const auto longitude = [&](double now) { return session.request(now, 640, 480)->eye.longitude.value(); };
  EXPECT_NEAR(longitude(last + 0.1), 128.3 + 1.1e-4, 1e-9);
  EXPECT_NEAR(longitude(last + 0.4), 128.3 + 1.4e-4, 1e-9);
  EXPECT_TRUE(session.needsImage(last + 0.45));
  // It stands still where the silence began, and nothing is drawn any more.
  EXPECT_NEAR(longitude(last + 0.7), 128.3 + 1.5e-4, 1e-9);
  EXPECT_FALSE(session.needsImage(last + 0.8));
  EXPECT_EQ(session.decision(), decision);

  session.setParameters(with([](TuningParameters& p) { p.host.extrapolate = false; }));
  EXPECT_TRUE(session.needsImage(last + 0.1));
  EXPECT_DOUBLE_EQ(longitude(last + 0.1), 128.3 + 1e-4);
  EXPECT_FALSE(session.needsImage(last + 0.2));
}

TEST(Session, jitterOfArrivalHardlyMovesTheEye) {
  Session session(defaultParameters());
  std::mt19937 random(3);
  std::uniform_real_distribution<double> late(0, 0.008);
  double worst = 0;
  for (int i = 0; i < 600; ++i) {
    AircraftState state = stateAt(i / 60.0, 5000, 0);
    state.position.longitude = Degrees{128.3 + 1e-3 * state.time};
    ReceivedState received = packet(state);
    received.kernelTime += late(random);
    session.receive(std::vector{received});
    if (i < 120) continue;
    const double now = 1000 + state.time + 0.010;
    const double meant = 128.3 + 1e-3 * (state.time + 0.010 - 0.004);
    worst = std::max(worst, std::abs(session.eyeState(now).position.longitude.value() - meant) / 1e-3);
  }
  EXPECT_LT(worst, 0.002) << "seconds of motion; arrivals alone wander by 0.008";
}

TEST(Session, everyPacketsLatencyEndsWithThePictureThatFirstShowsItOrANewerOne) {
  Session session(defaultParameters());
  session.keepRows(true);
  session.receive(std::vector{packet(stateAt(1.00, 5000, 0)), packet(stateAt(1.01, 5000, 0))});
  ASSERT_TRUE(session.request(1001.015, 64, 64)) << "asked for, but never drawn";
  ASSERT_TRUE(session.request(1001.02, 64, 64));
  session.receive(std::vector{packet(stateAt(1.03, 5000, 0))});  // while the picture is drawn
  const FrameCost cost = session.finished(resultCosting(20), 1001.04);
  EXPECT_EQ(session.latency().every.size(), 2u);
  EXPECT_NEAR(session.latency().every.largest(), 40, 1e-6);
  EXPECT_EQ(session.latency().shown.size(), 1u) << "one a picture: the newest packet's";
  EXPECT_NEAR(session.latency().shown.last(), 30, 1e-6);
  EXPECT_NEAR(session.latency().frame.last(), 20, 1e-6);
  EXPECT_NEAR(session.latency().decoded.largest(), 0.1, 1e-3);
  EXPECT_GE(cost.total, 20);
  EXPECT_GE(cost.decide, 0);

  std::vector<TraceRow> rows;
  session.takeRows(rows);
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_FALSE(rows[0].frame) << "overtaken before it was drawn";
  ASSERT_TRUE(rows[1].frame);
  EXPECT_EQ(rows[1].frame->counts.triangles, 77u);
  session.takeRows(rows);
  EXPECT_EQ(rows.size(), 2u) << "the third one waits for its picture";

  session.receive(std::vector{packet(stateAt(1.05, 5000, 0))});
  EXPECT_EQ(session.input().lastCost.total, cost.total);
  ASSERT_TRUE(session.request(1001.06, 64, 64));
  session.finished(resultCosting(5), 1001.07);
  session.takeRows(rows);
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_EQ(session.latency().every.size(), 4u);
  EXPECT_EQ(session.latency().shown.size(), 2u);
}

TEST(Session, aHiddenWindowNeitherKeepsRowsWaitingNorCountsAsLatency) {
  Session session(defaultParameters());
  session.keepRows(true);
  session.receive(std::vector{packet(stateAt(1, 5000, 0))});
  session.noPicture();
  std::vector<TraceRow> rows;
  session.takeRows(rows);
  EXPECT_EQ(rows.size(), 1u);
  session.request(1002, 64, 64);
  session.finished(resultCosting(1), 1002);
  EXPECT_EQ(session.latency().shown.size(), 0u);
  EXPECT_EQ(session.latency().every.size(), 0u);
}

TEST(Session, aFreeCameraLeavesNoMarkOnThePackets) {
  const ValidatedParameters parameters = defaultParameters();
  Session session(parameters), reference(parameters);
  session.keepRows(true);
  const std::vector<AircraftState> states = wanderingStates(300);
  for (std::size_t i = 0; i < states.size(); ++i) {
    session.look(states[states.size() - 1 - i]);
    EXPECT_TRUE(session.needsImage(1000));
    session.receive(std::vector{packet(states[i])});
    reference.receive(std::vector{packet(states[i])});
    ASSERT_EQ(session.decision(), reference.decision()) << i;
  }
  EXPECT_EQ(session.packets(), states.size());
  std::vector<TraceRow> rows;
  session.takeRows(rows, true);
  EXPECT_EQ(rows.size(), states.size());
}

TEST(Session, restartForgetsEverythingButParametersTerrainAndUntakenRows) {
  Session session(defaultParameters());
  session.keepRows(true);
  session.receive(std::vector{packet(stateAt(1, 3000, -10))});
  session.restart();
  EXPECT_FALSE(session.hasState());
  EXPECT_EQ(session.memory(), DecisionMemory{});
  EXPECT_EQ(session.linkState(1001), LinkState::never);
  EXPECT_EQ(session.packets(), 0u);
  EXPECT_FALSE(session.request(1001, 64, 64));
  session.receive(std::vector{packet(stateAt(1, 9000, 0))});
  std::vector<TraceRow> rows;
  session.takeRows(rows, true);
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[1].before, DecisionMemory{});
}

TEST(Session, statesThatAreNotNumbersDecideFrustumAndHarmNothing) {
  Session session(defaultParameters());
  session.receive(std::vector{packet(stateAt(1, 5000, 0))});
  const DecisionMemory memory = session.memory();
  for (const double bad : {kNan, std::numeric_limits<double>::infinity()}) {
    session.receive(std::vector{packet(stateAt(1.1, bad, 0)), packet(stateAt(1.2, 5000, bad))});
    EXPECT_EQ(session.decision().reason, SchemeReason::invalid_input);
    EXPECT_EQ(session.memory().band, memory.band);
  }
  session.receive(std::vector{packet(stateAt(1.3, 5000, 0))});
  EXPECT_EQ(session.decision().scheme, Scheme::dynamic);
}

}  // namespace
}  // namespace trimtab
