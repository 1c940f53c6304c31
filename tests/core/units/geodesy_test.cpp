#include "trimtab/units/geodesy.h"

#include <gtest/gtest.h>

#include <GeographicLib/Geocentric.hpp>
#include <GeographicLib/LocalCartesian.hpp>
#include <cmath>
#include <limits>
#include <random>

// The oracle is GeographicLib throughout.
namespace trimtab {
namespace {

using GeographicLib::Geocentric;

std::vector<GeodeticPosition> places() {
  std::vector<GeodeticPosition> all;
  for (const double lat : {-90.0, -89.9999999, -45.0, -1e-9, 0.0, 1e-300, 36.63, 45.0, 89.9999999, 90.0})
    for (const double lon : {-180.0, -179.9999999, -90.0, 0.0, 1e-12, 128.35, 179.9999999, 180.0})
      for (const double h : {-11000.0, -1e-3, 0.0, 8848.0, 1e5, 1e6})
        all.push_back({Degrees{lat}, Degrees{lon}, Metres{h}});
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int i = 0; i < 20000; ++i)
    all.push_back({Degrees{90 * unit(random)}, Degrees{180 * unit(random)}, Metres{1e5 * unit(random)}});
  return all;
}

}  // namespace

TEST(Geodesy, ecefAgreesWithGeographicLib) {
  for (const GeodeticPosition& p : places()) {
    double x, y, z;
    Geocentric::WGS84().Forward(p.latitude.value(), p.longitude.value(), p.height.value(), x, y, z);
    EXPECT_LT(length(toEcef(p) - Vec3{x, y, z}), 5e-9);
  }
}

TEST(Geodesy, geodeticComesBackWithinTenNanometres) {
  for (const GeodeticPosition& p : places()) {
    const Vec3 e = toEcef(p);
    const GeodeticPosition back = toGeodetic(e);
    EXPECT_LT(length(toEcef(back) - e), 1e-8) << p.latitude.value() << ' ' << p.longitude.value();
    EXPECT_NEAR(back.height.value(), p.height.value(), 1e-8);
    double lat, lon, h;
    Geocentric::WGS84().Reverse(e.x, e.y, e.z, lat, lon, h);
    EXPECT_NEAR(back.latitude.value(), lat, 1e-12);
    EXPECT_NEAR(back.height.value(), h, 1e-8);
  }
}

TEST(Geodesy, thePoleAndTheCentreArePoints) {
  EXPECT_LT(
      length(toEcef({Degrees{90}, Degrees{12}, Metres{5}}) - toEcef({Degrees{90}, Degrees{-170}, Metres{5}})),
      1e-9);
  EXPECT_EQ(toGeodetic(Vec3{0, 0, 0}).latitude, Degrees{90});
  EXPECT_EQ(toGeodetic(Vec3{0, 0, -7e6}).latitude, Degrees{-90});
}

TEST(LocalFrame, agreesWithGeographicLibAHundredKilometresOut) {
  for (const GeodeticPosition& origin : {GeodeticPosition{Degrees{36.63}, Degrees{128.35}, Metres{0}},
                                         GeodeticPosition{Degrees{-16.5}, Degrees{180}, Metres{100}},
                                         GeodeticPosition{Degrees{89.99}, Degrees{40}, Metres{0}}}) {
    const LocalFrame frame(origin);
    const GeographicLib::LocalCartesian oracle(origin.latitude.value(), origin.longitude.value(),
                                               origin.height.value());
    for (const double dLat : {-0.9, -0.01, 0.0, 0.005, 0.9})
      for (const double dLon : {-1.0, 0.0, 0.3, 1.0}) {
        const GeodeticPosition p{Degrees{std::min(90.0, origin.latitude.value() + dLat)},
                                 origin.longitude + Degrees{dLon}, Metres{3000}};
        double x, y, z;
        oracle.Forward(p.latitude.value(), p.longitude.value(), p.height.value(), x, y, z);
        EXPECT_LT(length(frame.fromGeodetic(p) - Vec3{x, y, z}), 1e-8);
        EXPECT_LT(length(toEcef(frame.toGeodetic(Vec3{x, y, z})) - toEcef(p)), 2e-8);
      }
  }
}

TEST(EyeAxes, followsTheConventionsOfFlight) {
  const GeodeticPosition here{Degrees{0}, Degrees{0}, Metres{0}};
  const LocalFrame frame(here);
  const auto axes = [&](double h, double p, double r) {
    return eyeAxes(frame, here, {Degrees{h}, Degrees{p}, Degrees{r}});
  };
  const auto near = [](Vec3 a, Vec3 b) { return length(a - b) < 1e-12; };
  EXPECT_TRUE(near(-axes(0, 0, 0).row[2], {0, 1, 0})) << "heading 0 looks north";
  EXPECT_TRUE(near(-axes(90, 0, 0).row[2], {1, 0, 0})) << "heading 90 looks east";
  EXPECT_TRUE(near(-axes(0, 90, 0).row[2], {0, 0, 1})) << "pitch is nose up";
  EXPECT_TRUE(near(axes(0, 0, 90).row[0], {0, 0, -1})) << "roll puts the right wing down";
  EXPECT_TRUE(near(axes(0, 0, 90).row[1], {1, 0, 0}));
  EXPECT_TRUE(near(axes(360, 0, 0).row[2], axes(0, 0, 0).row[2]));
}

TEST(EyeAxes, areOrthonormalAnywhere) {
  const LocalFrame frame({Degrees{36}, Degrees{128}, Metres{0}});
  for (const double lat : {-90.0, 0.0, 36.5, 90.0})
    for (const double h : {-720.5, 0.0, 45.0, 359.999}) {
      const Mat3 m = eyeAxes(frame, {Degrees{lat}, Degrees{-179}, Metres{1e5}},
                             {Degrees{h}, Degrees{89.9}, Degrees{-170}});
      EXPECT_NEAR(dot(m.row[0], m.row[1]), 0, 1e-14);
      EXPECT_NEAR(length(m.row[2]), 1, 1e-14);
      EXPECT_LT(length(cross(m.row[0], m.row[1]) - m.row[2]), 1e-14);
    }
}

TEST(Wrapping, staysInRangeAndKeepsTheDirection) {
  EXPECT_EQ(wrapped180(Degrees{190}), Degrees{-170});
  EXPECT_EQ(wrapped180(Degrees{-190}), Degrees{170});
  EXPECT_EQ(wrapped360(Degrees{-1}), Degrees{359});
  EXPECT_EQ(wrapped360(Degrees{720}), Degrees{0});
  EXPECT_LT(wrapped360(Degrees{-1e-300}).value(), 360);
  EXPECT_TRUE(std::isnan(wrapped180(Degrees{std::numeric_limits<double>::infinity()}).value()));
  EXPECT_TRUE(std::isnan(wrapped360(Degrees{std::nan("")}).value()));
}

}  // namespace trimtab
