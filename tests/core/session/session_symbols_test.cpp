#include <gtest/gtest.h>

#include <cmath>

#include "trimtab/frame/symbology_request.h"
#include "trimtab/session/session.h"

namespace trimtab {
namespace {

/// East at 100 m/s along the equator, climbing at 5, at 60 packets a second.
AircraftState flying(int i) {
  AircraftState state;
  state.time = 50 + i / 60.0;
  state.packet = static_cast<std::uint64_t>(i);
  constexpr double kPerDegree = 6378137 * M_PI / 180;
  state.position = {Degrees{0}, Degrees{128 + 100 * (i / 60.0) / kPerDegree}, Metres{1000 + 5 * (i / 60.0)}};
  state.attitude = {Degrees{90}, Degrees{2}, Degrees{0}};
  return state;
}

ValidatedParameters withSymbols() {
  TuningParameters p;
  p.symbology.enabled = true;
  return *validate(p);
}

TEST(SessionSymbols, areAskedForOnlyWhenEnabled) {
  Session session(defaultParameters());
  session.fly(flying(0));
  EXPECT_FALSE(session.request(0, 640, 360)->symbology);
  session.setParameters(withSymbols());
  EXPECT_TRUE(session.request(0, 640, 360)->symbology);
}

TEST(SessionSymbols, deriveSpeedFromPositionsAndLabelItGroundSpeed) {
  Session session(withSymbols());
  session.fly(flying(0));
  EXPECT_FALSE(session.request(0, 640, 360)->symbology->state.speed) << "one position has no speed";
  for (int i = 1; i < 60; ++i) session.fly(flying(i));
  const auto request = *session.request(0, 640, 360);
  const SymbologyState& state = request.symbology->state;
  EXPECT_TRUE(state.groundSpeed);
  EXPECT_NEAR(state.speed->in<MetresPerSecond>(), 100, 0.1);
  EXPECT_NEAR(state.velocity->east.value(), 100, 0.1);
  EXPECT_NEAR(state.velocity->down.value(), -5, 0.01);
  EXPECT_EQ(state.altitude, flying(59).position.height);
  EXPECT_EQ(request.time, flying(59).time);
  EXPECT_EQ(request.velocity, state.velocity);
}

TEST(SessionSymbols, prefersWhatTheHostSays) {
  Session session(withSymbols());
  for (int i = 0; i < 60; ++i) {
    AircraftState state = flying(i);
    state.airspeed = Knots{222};
    state.velocity = Velocity{MetresPerSecond{1}, MetresPerSecond{2}, MetresPerSecond{3}};
    session.fly(state);
  }
  const auto state = session.request(0, 640, 360)->symbology->state;
  EXPECT_FALSE(state.groundSpeed);
  EXPECT_EQ(state.speed, Knots{222});
  EXPECT_EQ(state.velocity->down, MetresPerSecond{3});
}

TEST(SessionSymbols, showAHeadThatIsTurned) {
  Session session(withSymbols());
  AircraftState state = flying(0);
  state.head = Attitude{Degrees{40}, Degrees{0}, Degrees{0}};
  session.fly(state);
  const auto symbols = session.request(0, 640, 360)->symbology->state;
  EXPECT_EQ(symbols.aircraft, state.attitude);
  EXPECT_NEAR(symbols.view.heading.value(), 130, 0.1);
}

/// A symbol that is visible in the first half of each second.
std::shared_ptr<const HostSymbols> flashing() {
  HostSymbol symbol;
  symbol.id = 5;
  symbol.visible = true;
  symbol.dutyPercent = 50;
  symbol.flashPeriodS = 1;
  symbol.shape = std::make_shared<const HostShape>();
  return std::make_shared<const HostSymbols>(HostSymbols{{}, {symbol}});
}

TEST(SessionSymbols, ofTheHostAreThoseOfTheLastPacketAndOfNoOtherSource) {
  Session session(withSymbols());
  const auto symbols = flashing();
  const std::vector<ReceivedState> packets{{flying(0), 100, 100, nullptr},
                                           {flying(1), 100.02, 100.02, symbols}};
  session.receive(packets);
  EXPECT_EQ(session.request(100.02, 640, 360)->symbology->host, symbols);
  session.look(flying(2));
  EXPECT_EQ(session.request(100.1, 640, 360)->symbology->host, nullptr) << "a free camera has none";
  session.receive(packets);
  session.fly(flying(2));
  EXPECT_EQ(session.request(100.1, 640, 360)->symbology->host, nullptr) << "nor has a flight";
}

TEST(SessionSymbols, ofTheHostAskForAnImageWhenTheyFlash) {
  TuningParameters p;
  p.symbology.enabled = true;
  for (const bool shown : {true, false}) {
    p.symbolHost.show = shown;
    Session session(*validate(p));
    AircraftState rests = flying(0);  // at 50 s on the host's clock
    for (int i = 0; i < 20; ++i, rests.time += 0.02)
      session.receive(std::vector{ReceivedState{rests, 100 + i * 0.02, 100 + i * 0.02, flashing()}});
    EXPECT_TRUE(session.request(100.4, 640, 360)->symbology->dark.empty());
    EXPECT_FALSE(session.needsImage(100.45));
    EXPECT_EQ(session.needsImage(100.55), shown) << "dark from 50.5 s on";
    const auto dark = session.request(100.55, 640, 360)->symbology->dark;
    EXPECT_EQ(dark, shown ? std::vector<std::uint16_t>{5} : std::vector<std::uint16_t>{});
    EXPECT_FALSE(session.needsImage(100.6));
  }
}

TEST(SessionSymbols, haveNoSpeedWhileTheCameraStands) {
  Session session(withSymbols());
  for (int i = 0; i < 30; ++i) session.look(flying(i));
  EXPECT_NEAR(session.request(0, 640, 360)->symbology->state.speed->in<MetresPerSecond>(), 100, 0.1);
  AircraftState stands = flying(29);
  stands.time += 0.02;
  session.look(stands);
  EXPECT_EQ(session.request(0, 640, 360)->symbology->state.speed, Knots{0});
}

}  // namespace
}  // namespace trimtab
