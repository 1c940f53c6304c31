#include "trimtab/host/ground_velocity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace trimtab {
namespace {

AircraftState at(double time, double latitude, double longitude, double height) {
  AircraftState s;
  s.time = time;
  s.position = {Degrees{latitude}, Degrees{longitude}, Metres{height}};
  return s;
}

/// Metres of a degree of latitude and of longitude at 60 N, by the ellipsoid's radii of curvature.
constexpr double kA = 6378137, kE2 = 0.0066943799901413165;
double perLatitude(double degrees) {
  const double s = std::sin(degrees * M_PI / 180);
  return kA * (1 - kE2) / std::pow(1 - kE2 * s * s, 1.5) * M_PI / 180;
}
double perLongitude(double degrees) {
  const double s = std::sin(degrees * M_PI / 180);
  return kA / std::sqrt(1 - kE2 * s * s) * std::cos(degrees * M_PI / 180) * M_PI / 180;
}

TEST(GroundVelocity, isWhatPositionsSay) {
  for (const double hz : {10.0, 60.0, 300.0}) {
    GroundVelocity v;
    EXPECT_FALSE(v.velocity());
    for (int i = 0; i < 400; ++i) {
      const double t = i / hz;
      v.push(at(t, 60 + 100 * t / perLatitude(60), 179.99 + 70 * t / perLongitude(60), 500 - 5 * t));
    }
    ASSERT_TRUE(v.velocity());
    EXPECT_NEAR(v.velocity()->north.value(), 100, 0.05) << hz;
    EXPECT_NEAR(v.velocity()->east.value(), 70, 0.2) << hz << ": meridians close in on the way";
    EXPECT_NEAR(v.velocity()->down.value(), 5, 0.05) << hz;
  }
}

TEST(GroundVelocity, crossesTheDateLine) {
  GroundVelocity v;
  for (int i = 0; i < 60; ++i) {
    const double longitude = 179.9999 + i * 0.00002;
    v.push(at(i / 60.0, 0, longitude > 180 ? longitude - 360 : longitude, 100));
  }
  ASSERT_TRUE(v.velocity());
  EXPECT_NEAR(v.velocity()->east.value(), 0.00002 * 60 * perLongitude(0), 0.05);
}

TEST(GroundVelocity, isNoughtAtRestAndUnknownAfterAJump) {
  GroundVelocity v;
  for (int i = 0; i < 30; ++i) v.push(at(i / 60.0, 10, 20, 100));
  ASSERT_TRUE(v.velocity());
  EXPECT_EQ(v.velocity()->north.value(), 0);
  EXPECT_EQ(v.velocity()->down.value(), 0);
  v.push(at(0.51, 11, 20, 100));
  EXPECT_FALSE(v.velocity()) << "a jump";
  v.push(at(0.53, 11, 20, 100));
  EXPECT_TRUE(v.velocity());
  v.push(at(0.2, 11, 20, 100));
  EXPECT_FALSE(v.velocity()) << "time went back";
  v.push(at(0.3, 11, 20, 100));
  EXPECT_TRUE(v.velocity());
  v.push(at(5, 11, 20, 100));
  EXPECT_FALSE(v.velocity()) << "a silence";
  v.push(at(std::numeric_limits<double>::quiet_NaN(), 11, 20, 100));
  EXPECT_FALSE(v.velocity());
}

TEST(GroundVelocity, takesTheSameStateTwice) {
  GroundVelocity v;
  v.push(at(1, 10, 20, 100));
  v.push(at(1.1, 10, 20, 110));
  const auto once = v.velocity();
  v.push(at(1.1, 10, 20, 110));
  EXPECT_EQ(v.velocity(), once);
  EXPECT_NEAR(once->down.value(), -100, 1e-6);
}

}  // namespace
}  // namespace trimtab
