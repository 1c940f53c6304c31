#include "trimtab/motion/line_of_sight.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace trimtab {
namespace {

Attitude attitude(double heading, double pitch, double roll = 0) {
  return {Degrees{heading}, Degrees{pitch}, Degrees{roll}};
}

TEST(LineOfSight, isTheAircraftsWithoutAHeadOrWithOneThatLooksAhead) {
  const Attitude aircraft = attitude(123.4, 5.6, 7.8);
  EXPECT_EQ(lineOfSight(aircraft, std::nullopt), aircraft);
  EXPECT_EQ(lineOfSight(aircraft, Attitude{}), aircraft);
}

TEST(LineOfSight, addsHeadingsInLevelFlight) {
  const Attitude sight = lineOfSight(attitude(350, 0), attitude(30, -20));
  EXPECT_NEAR(sight.heading.value(), 20, 1e-9);
  EXPECT_NEAR(sight.pitch.value(), -20, 1e-9);
  EXPECT_NEAR(sight.roll.value(), 0, 1e-9);
}

TEST(LineOfSight, looksDownOverALoweredWing) {
  // Banked 90 degrees to the right, a look to the right is a look straight down.
  const Attitude sight = lineOfSight(attitude(0, 0, 60), attitude(90, 0));
  EXPECT_NEAR(sight.heading.value(), 90, 1e-9);
  EXPECT_NEAR(sight.pitch.value(), -60, 1e-9);
}

TEST(LineOfSight, keepsTheHeadingStraightUp) {
  const Attitude sight = lineOfSight(attitude(40, 60), attitude(0, 30));
  EXPECT_NEAR(sight.pitch.value(), 90, 1e-5);
  EXPECT_TRUE(std::isfinite(sight.heading.value()));
  EXPECT_NEAR(sight.heading.value(), 40, 1e-3);
}

/// Forward axis by rotating it about one axis after the other, without matrices.
TEST(LineOfSight, pointsWhereTurningAxisByAxisPoints) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> turn(-180, 180), quarter(-89, 89);
  const auto rotated = [](double& a, double& b, double degrees) {
    const double c = std::cos(Degrees{degrees}.in<Radians>()), s = std::sin(Degrees{degrees}.in<Radians>());
    const double first = a * c - b * s;
    b = a * s + b * c;
    a = first;
  };
  for (int i = 0; i < 2000; ++i) {
    const Attitude body = attitude(turn(random), quarter(random), turn(random));
    const Attitude head = attitude(turn(random), quarter(random), turn(random));
    double forward = 1, right = 0, down = 0;
    for (const Attitude& a : {head, body}) {
      rotated(right, down, a.roll.value());
      rotated(down, forward, a.pitch.value());
      rotated(forward, right, a.heading.value());
    }
    const Attitude sight = lineOfSight(body, head);
    const double pitch = sight.pitch.in<Radians>(), heading = sight.heading.in<Radians>();
    EXPECT_NEAR(std::cos(pitch) * std::cos(heading), forward, 1e-9);
    EXPECT_NEAR(std::cos(pitch) * std::sin(heading), right, 1e-9);
    EXPECT_NEAR(-std::sin(pitch), down, 1e-9);
  }
}

/// Unit quaternions, as an independent way to turn a vector by heading, pitch and roll.
struct Quaternion {
  double w, x, y, z;
  friend Quaternion operator*(Quaternion a, Quaternion b) {
    return {a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
            a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
  }
};
Quaternion quaternionOf(const Attitude& a) {
  const double h = a.heading.in<Radians>() / 2, p = a.pitch.in<Radians>() / 2, r = a.roll.in<Radians>() / 2;
  return Quaternion{std::cos(h), 0, 0, std::sin(h)} * Quaternion{std::cos(p), 0, std::sin(p), 0} *
         Quaternion{std::cos(r), std::sin(r), 0, 0};
}

TEST(LineOfSight, isTheHeadsTurnInsideTheAircraftsTurn) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> turn(-180, 180), nod(-90, 90);
  for (int i = 0; i < 2000; ++i) {
    Attitude aircraft{Degrees{turn(random)}, Degrees{nod(random)}, Degrees{turn(random)}};
    Attitude head{Degrees{turn(random)}, Degrees{nod(random)}, Degrees{turn(random)}};
    if (i % 5 == 0) aircraft = {aircraft.heading, Degrees{i % 2 ? 90.0 : -90.0}, Degrees{0}};
    if (i % 10 == 0) head = {Degrees{0}, Degrees{0}, head.roll};
    const Quaternion meant = quaternionOf(aircraft) * quaternionOf(head);
    const Quaternion got = quaternionOf(lineOfSight(aircraft, head));
    const double same = std::abs(meant.w * got.w + meant.x * got.x + meant.y * got.y + meant.z * got.z);
    // Near the vertical, heading and roll come from a difference of 1e-8 or so.
    EXPECT_NEAR(same, 1, 1e-11) << i;
  }
}

}  // namespace
}  // namespace trimtab
