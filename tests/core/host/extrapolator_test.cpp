#include <cmath>
#include <random>

#include "host_support.h"
#include "tests/support.h"
#include "trimtab/host/host_clock_offset.h"
#include "trimtab/host/motion.h"

namespace trimtab::test {
namespace {

/// 250 m/s along a straight line of space from `start`, turning by 3 degrees a second.
AircraftState moving(const GeodeticPosition& start, Vec3 velocity, double t) {
  AircraftState s;
  s.time = t;
  s.position = toGeodetic(toEcef(start) + velocity * t);
  s.attitude = {wrapped360(Degrees{359.9 + 3 * t}), Degrees{2 + t}, wrapped180(Degrees{179.9 + 5 * t})};
  s.head = Attitude{wrapped180(Degrees{179.5 + 40 * t}), Degrees{-10 * t}, Degrees{0}};
  return s;
}

struct Place {
  const char* name;
  GeodeticPosition start;
  Vec3 velocity;
};
const Place kPlaces[] = {
    {"mid-latitudes", {Degrees{36.6}, Degrees{128.3}, Metres{1500}}, {-100, -200, 100}},
    {"date line", {Degrees{-17}, Degrees{179.9999}, Metres{1500}}, {-5, -250, 0}},
    {"pole", {Degrees{89.9999}, Degrees{10}, Metres{3000}}, {-200, -150, 0}},
};

TEST(HostClockOffset, followsAClockWithJitterAndTakesOverOneThatSteps) {
  HostClockOffset offset;
  EXPECT_EQ(offset.hostTime(7), 7) << "nothing is known yet";
  offset.follow(1000, 50);
  EXPECT_EQ(offset.hostTime(50.5), 1000.5);
  for (int i = 1; i < 200; ++i) {
    const double late = i % 2 == 0 ? 0.002 : 0.004;
    offset.follow(1000 + i / 60.0, 50 + i / 60.0 + late);
    EXPECT_NEAR(offset.hostTime(50 + i / 60.0), 1000 + i / 60.0, 0.0041);
  }
  offset.follow(3, 60);
  EXPECT_EQ(offset.hostTime(60), 3) << "a host that begins anew";
}

TEST(Extrapolator, goesOnAtConstantVelocityAndTurnRate) {
  for (const Place& place : kPlaces) {
    SCOPED_TRACE(place.name);
    Extrapolator extrapolator;
    for (int i = 0; i <= 20; ++i) extrapolator.push(moving(place.start, place.velocity, i / 60.0));
    const double t = 20 / 60.0 + 0.1;
    const AircraftState truth = moving(place.start, place.velocity, t), got = extrapolator.at(t, 0.5);
    EXPECT_LT(distanceM(got.position, truth.position), 0.01);
    EXPECT_NEAR(wrapped180(got.attitude.heading - truth.attitude.heading).value(), 0, 1e-6);
    EXPECT_NEAR(wrapped180(got.attitude.roll - truth.attitude.roll).value(), 0, 1e-6);
    EXPECT_NEAR(got.attitude.pitch.value(), truth.attitude.pitch.value(), 1e-6);
    EXPECT_NEAR(wrapped180(got.head->heading - truth.head->heading).value(), 0, 1e-6);
    EXPECT_NEAR(got.time, t, 1e-12);
    EXPECT_GE(got.attitude.heading.value(), 0);
    EXPECT_LT(got.attitude.heading.value(), 360);
  }
}

TEST(Extrapolator, staysAtTheLimitAndNeverGoesBack) {
  Extrapolator extrapolator;
  const Place& place = kPlaces[0];
  for (int i = 0; i <= 20; ++i) extrapolator.push(moving(place.start, place.velocity, i / 60.0));
  const double last = 20 / 60.0;
  EXPECT_EQ(extrapolator.at(last + 0.6, 0.5), extrapolator.at(last + 50, 0.5));
  EXPECT_NE(extrapolator.at(last + 0.4, 0.5), extrapolator.at(last + 0.5, 0.5));
  EXPECT_EQ(extrapolator.at(last + 0.1, 0), moving(place.start, place.velocity, last));
  EXPECT_EQ(extrapolator.at(last - 0.1, 0.5), moving(place.start, place.velocity, last));
  EXPECT_EQ(extrapolator.at(std::nan(""), 0.5), moving(place.start, place.velocity, last));
  EXPECT_EQ(extrapolator.at(last + 0.1, std::nan("")), moving(place.start, place.velocity, last));
}

TEST(Extrapolator, neverCrossesAJumpASilenceOrAClockThatWentBack) {
  const Place& place = kPlaces[0];
  const auto pushed = [&](const AircraftState& odd) {
    Extrapolator extrapolator;
    for (int i = 0; i <= 20; ++i) extrapolator.push(moving(place.start, place.velocity, i / 60.0));
    extrapolator.push(odd);
    return extrapolator.at(odd.time + 0.1, 0.5) == odd;
  };
  AircraftState jumped = moving(place.start, place.velocity, 21 / 60.0);
  jumped.position.latitude = jumped.position.latitude + Degrees{0.1};
  EXPECT_TRUE(pushed(jumped));
  EXPECT_TRUE(pushed(moving(place.start, place.velocity, 10)));
  AircraftState back = moving(place.start, place.velocity, 0.1);
  EXPECT_TRUE(pushed(back));
  EXPECT_FALSE(pushed(moving(place.start, place.velocity, 21 / 60.0)));
}

TEST(Extrapolator, isNotThrownByArrivalsThatBunchTogether) {
  // native-fdm: the states' times are arrivals. One packet comes 16 ms late, the next right behind it.
  Extrapolator extrapolator;
  const Place& place = kPlaces[0];
  AircraftState s;
  for (int i = 0; i <= 40; ++i) {
    s = moving(place.start, place.velocity, i / 60.0);
    if (i == 39) s.time += 0.0166;
    extrapolator.push(s);
  }
  const AircraftState got = extrapolator.at(s.time + 1 / 60.0, 0.5);
  const double speed = distanceM(got.position, s.position) * 60;
  EXPECT_NEAR(speed, length(place.velocity), 0.35 * length(place.velocity));
}

TEST(Extrapolator, isEmptyBeforeTheFirstState) {
  EXPECT_EQ(Extrapolator().at(5, 1), AircraftState{});
}

}  // namespace
}  // namespace trimtab::test
