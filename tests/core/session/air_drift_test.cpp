#include "trimtab/session/air_drift.h"

#include <gtest/gtest.h>

#include <limits>

#include "trimtab/session/session.h"

namespace trimtab {
namespace {

const GeodeticPosition kEquator{Degrees{0}, Degrees{0}, Metres{1000}};
const Wind kWest{MetresPerSecond{10}, Degrees{270}, MetresPerSecond{0}};

TEST(AirDrift, isTheSumOfTheWindOverTime) {
  AirDrift drift;
  drift.advance(100, kEquator, kWest);
  EXPECT_EQ(drift.metres(), Vec3{}) << "no time has passed";
  for (int i = 1; i <= 50; ++i) drift.advance(100 + 0.02 * i, kEquator, kWest);
  // East at latitude and longitude 0 is the earth's y axis.
  EXPECT_LT(length(drift.metres() - Vec3{0, 10, 0}), 1e-9);
  const Wind south{MetresPerSecond{4}, Degrees{180}, MetresPerSecond{2}};
  drift.advance(102, kEquator, south);
  EXPECT_LT(length(drift.metres() - Vec3{2, 10, 4}), 1e-9) << "a wind that turns moves on from where it is";
}

TEST(AirDrift, leavesOutGapsAndTimeThatGoesBack) {
  AirDrift drift;
  drift.advance(0, kEquator, kWest);
  for (const double time : {-50.0, 100.0, std::numeric_limits<double>::quiet_NaN()}) {
    drift.advance(time, kEquator, kWest);
    EXPECT_EQ(drift.metres(), Vec3{}) << time;
  }
  drift.advance(100.5, kEquator, kWest);
  EXPECT_LT(length(drift.metres() - Vec3{0, 5, 0}), 1e-9);
  for (const double time : {100.3, 100.4, 100.5}) drift.advance(time, kEquator, kWest);
  EXPECT_LT(length(drift.metres() - Vec3{0, 5, 0}), 1e-9) << "a packet corrected the time";
  drift.advance(100.7, kEquator, kWest);
  EXPECT_LT(length(drift.metres() - Vec3{0, 7, 0}), 1e-9);
}

TEST(AirDrift, ofASessionIsInItsRequests) {
  TuningParameters parameters;
  parameters.weather.windSpeed = MetresPerSecond{20};
  parameters.weather.windFrom = Degrees{270};
  Session session(*validate(parameters));
  for (int i = 0; i <= 10; ++i) {
    AircraftState state;
    state.time = 0.1 * i;
    state.position = kEquator;
    session.fly(state);
    const auto request = session.request(50 + 0.1 * i, 320, 200);
    ASSERT_TRUE(request);
    EXPECT_LT(length(request->airDrift - Vec3{0, 2.0 * i, 0}), 1e-6) << i;
  }
}

}  // namespace
}  // namespace trimtab
