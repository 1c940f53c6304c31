#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "tests/support.h"
#include "trimtab/frame/ground_heights.h"
#include "trimtab/host/received_state.h"
#include "trimtab/session/session.h"

/// Aircraft that stand on the ground, and hosts that do not know how far it is below.
namespace trimtab {
namespace {

using testing::HasSubstr;

/// A hill side of 310 m that rises to the north and falls to the east; unknown in the west.
class HillSide : public GroundHeights {
 public:
  static constexpr double kNorth = 0.2, kEast = -0.1;
  std::optional<Metres> heightAt(Degrees latitude, Degrees longitude) const override {
    if (longitude < Degrees{10}) return std::nullopt;
    const Vec3 local = frame_.fromGeodetic({latitude, longitude, Metres{0}});
    return Metres{310 + kNorth * local.y + kEast * local.x};
  }

 private:
  LocalFrame frame_{GeodeticPosition{Degrees{46}, Degrees{11}, Metres{0}}};
};

AircraftState at(double longitude, double heightM) {
  AircraftState state;
  state.time = 1;
  state.position = {Degrees{46}, Degrees{longitude}, Metres{heightM}};
  return state;
}

AircraftState seen(const AircraftState& state) {
  Session session(defaultParameters());
  session.setGround(std::make_shared<HillSide>());
  session.receive(std::vector{ReceivedState{state, 1000, 1000}});
  return session.input().state;
}

TEST(ClampedAircraft, stands) {
  AircraftState state = at(11, 2.5);
  state.attitude = {Degrees{70}, Degrees{4}, Degrees{-3}};
  EXPECT_EQ(seen(state), state) << "nobody clamps it";
  state.clamp = GroundClamp::level;
  const AircraftState level = seen(state);
  EXPECT_NEAR(level.position.height.value(), 312.5, 1e-9);
  EXPECT_EQ(level.aboveGround, Metres{2.5});
  EXPECT_EQ(level.attitude, state.attitude) << "pitch and roll are the host's";
  EXPECT_EQ(level.clamp, GroundClamp::none);
  state.position.longitude = Degrees{9};
  EXPECT_EQ(seen(state).position.height, Metres{2.5}) << "over the sea, for all that is known";
}

TEST(ClampedAircraft, conformsToTheSlopeFromEveryHeading) {
  constexpr double kDegree = 180 / std::numbers::pi;
  AircraftState state = at(11, 0);
  state.clamp = GroundClamp::conformal;
  for (double heading = 0; heading < 360; heading += 22.5) {
    SCOPED_TRACE(heading);
    state.attitude = {Degrees{heading}, {}, {}};
    const Attitude attitude = seen(state).attitude;
    EXPECT_NEAR(attitude.heading.value(), heading, 1e-6);
    const double east = std::sin(heading / kDegree), north = std::cos(heading / kDegree);
    const double ahead = HillSide::kEast * east + HillSide::kNorth * north;
    EXPECT_NEAR(attitude.pitch.value(), std::atan(ahead) * kDegree, 1e-3);
    // The right wing lies on the slope: roll is down where the ground falls to the right of the nose's plane.
    const double right = HillSide::kEast * north - HillSide::kNorth * east;
    EXPECT_NEAR(attitude.roll.value(), -std::atan(right / std::sqrt(1 + ahead * ahead)) * kDegree, 1e-3);
  }
  // Pitch and roll of the host count from there.
  state.attitude = {Degrees{0}, Degrees{5}, {}};
  EXPECT_NEAR(seen(state).attitude.pitch.value(), std::atan(0.2) * kDegree + 5, 0.2);
  // A flight that was recorded stands on the ground as well.
  Session session(defaultParameters());
  session.setGround(std::make_shared<HillSide>());
  session.fly(state);
  EXPECT_NEAR(session.input().state.position.height.value(), 310, 1e-9);
}

ValidatedParameters aboveGround() {
  TuningParameters parameters;
  parameters.altitude.reference = AltitudeReference::above_ground;
  return validate(parameters).value();
}

TEST(HostsHeightAboveGround, isDoubtedWhereTheTerrainContradictsIt) {
  struct Case {
    const char* name;
    double longitude, heightM, hostM, usedM;
    bool doubted, isAltitude;
  };
  const Case cases[] = {
      {"the altitude in its place", 11, 900, 900, 590, true, true},
      {"the altitude as a float", 11, 900.0123, static_cast<float>(900.0123), 590.0123, true, true},
      {"counted from the runway", 11, 900, 800, 590, true, false},
      {"in feet", 11, 410, 328, 100, true, false},
      {"another model of the ground", 11, 900, 560, 590, false, false},

      {"no terrain here", 9, 900, 900, 900, false, false},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.name);
    for (const bool watched : {false, true}) {
      Session session(aboveGround());
      session.setGround(std::make_shared<HillSide>());
      if (watched) session.watchSignals();
      AircraftState state = at(c.longitude, c.heightM);
      state.aboveGround = Metres{c.hostM};
      for (int i = 0; i < 3; ++i) session.receive(std::vector{ReceivedState{state, 1000.0 + i, 1000.0 + i}});
      EXPECT_NEAR(session.input().aboveGround->value(), c.usedM, 1e-6);
      ASSERT_EQ(session.groundDoubt().has_value(), c.doubted);
      if (!c.doubted) continue;
      EXPECT_EQ(session.groundDoubt()->states, 3U);
      EXPECT_EQ(session.groundDoubt()->isAltitude, c.isAltitude);
    }
  }
}

TEST(HostsHeightAboveGround, thatEqualsTheAltitudeIsRightOverTheSeaAlone) {
  class Low : public GroundHeights {
   public:
    explicit Low(double heightM) : height_(heightM) {}
    std::optional<Metres> heightAt(Degrees, Degrees) const override { return Metres{height_}; }

   private:
    double height_;
  };
  for (const auto& [ground, doubted] : {std::pair{0.5, false}, {8.0, true}, {-4.0, true}}) {
    Session session(aboveGround());
    session.setGround(std::make_shared<Low>(ground));
    AircraftState state = at(11, 700);
    state.aboveGround = Metres{700};
    session.receive(std::vector{ReceivedState{state, 1000, 1000}});
    EXPECT_EQ(session.groundDoubt().has_value(), doubted) << ground;
  }
}

TEST(HostsHeightAboveGround, isDoubtedInASentence) {
  Session session(aboveGround());
  session.setGround(std::make_shared<HillSide>());
  AircraftState state = at(11, 418.25);
  state.aboveGround = Metres{418.25};
  session.receive(std::vector{ReceivedState{state, 1000, 1000}});
  EXPECT_EQ(
      toString(toFinding(*session.groundDoubt())),
      "host: height above ground: expected 108.3 m, over the terrain, found 418.3 m, which is the altitude "
      "above sea level: this host knows no ground; the terrain's is used");
  session.restart();
  EXPECT_FALSE(session.groundDoubt());
}

}  // namespace
}  // namespace trimtab
