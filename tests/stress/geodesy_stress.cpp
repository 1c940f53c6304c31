#include <gtest/gtest.h>

#include <GeographicLib/Geocentric.hpp>
#include <GeographicLib/LocalCartesian.hpp>
#include <cmath>
#include <random>
#include <vector>

#include "quad.h"
#include "table.h"
#include "trimtab/motion/line_of_sight.h"
#include "trimtab/units/geodesy.h"

namespace trimtab::stress {
namespace {

constexpr double kFarthest = 7.4e6;  ///< metres from the earth's centre of what is tried: 1,000 km up

Quad3 ecefTwin(const GeodeticPosition& p) {
  const Quad a = 6378137, f = 1 / (Quad{298257223563.0} / 1000000000), e2 = f * (2 - f);
  const Quad sinLat = sinDegrees(p.latitude.value()), cosLat = cosDegrees(p.latitude.value());
  const Quad n = a / sqrtq(1 - e2 * sinLat * sinLat), h = p.height.value();
  return {(n + h) * cosLat * cosDegrees(p.longitude.value()),
          (n + h) * cosLat * sinDegrees(p.longitude.value()), (n * (1 - e2) + h) * sinLat};
}

struct Quad3x3 {
  Quad3 row[3];
  Quad3 operator*(Quad3 v) const { return {dot(row[0], v), dot(row[1], v), dot(row[2], v)}; }
};
Quad3x3 eastNorthUpTwin(Quad latitude, Quad longitude) {
  const Quad sa = sinDegrees(latitude), ca = cosDegrees(latitude), so = sinDegrees(longitude),
             co = cosDegrees(longitude);
  return {{{-so, co, 0}, {-sa * co, -sa * so, ca}, {ca * co, ca * so, sa}}};
}

std::string text(const GeodeticPosition& p) {
  return digits(p.latitude.value()) + ", " + digits(p.longitude.value()) + ", " + digits(p.height.value()) +
         " m";
}

/// Poles, equator, date line and zero meridian, at and beside; from below the lowest terrain to 1,000 km up.
std::vector<GeodeticPosition> corners() {
  std::vector<GeodeticPosition> places;
  const auto beside = [](double x) {
    std::vector<double> all{x};
    for (const double d : {1e-15, 1e-13, 1e-9, 1e-6, 1e-3}) all.push_back(x + d), all.push_back(x - d);
    all.push_back(stepped(x, 1)), all.push_back(stepped(x, -1));
    return all;
  };
  for (const double latitude : {-90.0, -45.0, 0.0, 45.0, 60.0, 90.0})
    for (const double a : beside(latitude))
      for (const double longitude : {-180.0, -90.0, 0.0, 90.0, 180.0, 127.5})
        for (const double o : beside(longitude))
          for (const double h : {-11000.0, -430.0, 0.0, 8848.0, 100e3, 1000e3})
            if (std::abs(a) <= 90 && std::abs(o) <= 180)
              places.push_back({Degrees{a}, Degrees{o}, Metres{h}});
  return places;
}

GeodeticPosition randomPlace(std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  const double kind = unit(random),
               up = unit(random) < 0.7 ? 20000 * unit(random) - 1000 : -20000 + 1.02e6 * unit(random);
  double latitude = 180 * unit(random) - 90, longitude = 360 * unit(random) - 180;
  if (kind < 0.1) latitude = std::copysign(90 - std::pow(10, -14 * unit(random)), latitude);
  if (kind > 0.9) longitude = std::copysign(180 - std::pow(10, -14 * unit(random)), longitude);
  return {Degrees{latitude}, Degrees{longitude}, Metres{up}};
}

TEST(GeodesyStress, convertsToTheEarthsFrameAndBack) {
  std::mt19937_64 random(11);
  Case forward("geodesy", "toEcef against exact arithmetic", 16 * kU * kFarthest, "m",
               "16 roundings a component (angle, sine, cosine, radius, products) at 7,400 km");
  Case back("geodesy", "toGeodetic: its place against the point it was given", 10e-9, "m",
            "geodesy.h promises 10 nm within 1,000 km of the surface");
  Case round("geodesy", "round trip", 10e-9 + 16 * kU * kFarthest, "m", "10 nm back, 13 nm there");
  Case oracle("geodesy", "toEcef against GeographicLib", 16 * kU * kFarthest + 7e-9, "m",
              "our 13 nm and the 7 nm that GeographicLib states");
  Case oracleBack("geodesy", "toGeodetic against GeographicLib", 10e-9 + 7e-9, "m",
                  "our 10 nm and the 7 nm that GeographicLib states");
  Case angles("geodesy", "toGeodetic in -90..90 and -180..180", 0, "violations",
              "what quantities and hosts may hold");
  const auto& library = GeographicLib::Geocentric::WGS84();
  std::vector<GeodeticPosition> places = corners();
  const std::size_t count = samples(100000);
  for (std::size_t i = 0; i < places.size() + count; ++i) {
    const GeodeticPosition p = i < places.size() ? places[i] : randomPlace(random);
    const auto where = [&] { return text(p); };
    const Vec3 ecef = toEcef(p);
    const Quad3 exact = ecefTwin(p);
    forward.see(distance(ecef, exact), where);
    double x, y, z;
    library.Forward(p.latitude.value(), p.longitude.value(), p.height.value(), x, y, z);
    oracle.see(length(ecef - Vec3{x, y, z}), where);
    const GeodeticPosition again = toGeodetic(ecef);
    const Quad3 placed = ecefTwin(again);
    back.see(distance(ecef, placed), where);
    round.see(toDouble(length(placed - exact)), where);
    double latitude, longitude, height;
    library.Reverse(ecef.x, ecef.y, ecef.z, latitude, longitude, height);
    oracleBack.see(
        toDouble(length(placed - ecefTwin({Degrees{latitude}, Degrees{longitude}, Metres{height}}))), where);
    angles.require(std::abs(again.latitude.value()) <= 90 && std::abs(again.longitude.value()) <= 180, where);
  }
}

TEST(GeodesyStress, aLocalFrameIsAnIsometry) {
  std::mt19937_64 random(12);
  std::uniform_real_distribution<double> unit(-1, 1);
  constexpr double kReach = 1e6;
  Case into("local frame", "fromGeodetic against exact arithmetic", 32 * kU * kFarthest + 16 * kU * kReach,
            "m", "two places of 16 roundings each, and the rotation's sixteen of 1,000 km");
  Case oracle("local frame", "fromGeodetic against GeographicLib",
              32 * kU * kFarthest + 16 * kU * kReach + 14e-9, "m",
              "ours and twice the 7 nm that GeographicLib states");
  Case out("local frame", "there and back through ECEF", 16 * kU * kReach + 8 * kU * kFarthest, "m",
           "two rotations of 1,000 km (16 roundings) and sums at 7,400 km (8)");
  Case lengths("local frame", "lengths of a kilometre kept", 16 * kU * kFarthest, "m",
               "the differences of four sums at 7,400 km");
  std::vector<GeodeticPosition> origins = corners();
  const std::size_t count = samples(20000);
  for (std::size_t i = 0; i < count; ++i) {
    const GeodeticPosition origin = i % 4 == 0 ? origins[(i / 4 * 37) % origins.size()] : randomPlace(random);
    if (origin.height.value() > 100e3) continue;
    const LocalFrame frame(origin);
    const double reach = std::pow(10, 3 + 3 * std::abs(unit(random)));
    const Vec3 local{reach * unit(random) / 2, reach * unit(random) / 2, 20000 * unit(random)};
    const GeodeticPosition p = frame.toGeodetic(local);
    const Vec3 ours = frame.fromGeodetic(p);
    const auto where = [&] { return text(p) + " from " + text(origin); };
    const Quad3 exact =
        eastNorthUpTwin(origin.latitude.value(), origin.longitude.value()) * (ecefTwin(p) - ecefTwin(origin));
    into.see(distance(ours, exact), where);
    GeographicLib::LocalCartesian library(origin.latitude.value(), origin.longitude.value(),
                                          origin.height.value());
    double x, y, z;
    library.Forward(p.latitude.value(), p.longitude.value(), p.height.value(), x, y, z);
    oracle.see(length(ours - Vec3{x, y, z}), where);
    out.see(length(frame.fromEcef(frame.toEcef(local)) - local), where);
    const Vec3 step{1000, 0, 0};
    lengths.see(
        std::abs(length(frame.toEcef(local + step) - frame.toEcef(local)) - length(local + step - local)),
        where);
  }
}

TEST(AngleStress, anglesWrapAtFullTurns) {
  std::mt19937_64 random(13);
  std::uniform_real_distribution<double> unit(-1, 1);
  Case half("angles", "wrapped180", 0, "deg", "the remainder of doubles is exact");
  Case whole("angles", "wrapped360", 0, "deg",
             "exact arithmetic, rounded once; what rounds to a whole turn is none");
  Case range("angles", "wrapped360 in 0..360, wrapped180 in -180..180", 0, "violations", "geodesy.h");
  const auto check = [&](double a) {
    const double h = wrapped180(Degrees{a}).value(), w = wrapped360(Degrees{a}).value();
    half.see(distance(h, remainderq(a, 360)), [&] { return digits(a); });
    Quad exact = fmodq(a, 360);
    if (exact < 0) exact += 360;
    const double once = toDouble(exact);
    whole.see(distance(w, once == 360 ? 0 : once), [&] { return digits(a); });
    range.require(w >= 0 && w < 360 && std::abs(h) <= 180, [&] { return digits(a); });
  };
  for (int turn = -8; turn <= 8; ++turn)
    for (int ulps = -3; ulps <= 3; ++ulps)
      check(stepped(90.0 * turn, ulps)), check(stepped(90.0 * turn + 1e-9, ulps));
  for (const double a : {5e-324, -5e-324, 1e-20, -1e-20, 1e15, -1e15, 1e300, -1e300}) check(a);
  for (std::size_t i = 0; i < samples(100000); ++i) check(unit(random) * std::pow(10, 20 * unit(random)));
  for (const double none : {std::nan(""), HUGE_VAL, -HUGE_VAL})
    range.require(std::isnan(wrapped180(Degrees{none}).value()) &&
                  std::isnan(wrapped360(Degrees{none}).value()));
}

/// Right, up and backward of an attitude in east, north, up.
Quad3x3 axesTwin(const Attitude& a) {
  const Quad sh = sinDegrees(a.heading.value()), ch = cosDegrees(a.heading.value());
  const Quad sp = sinDegrees(a.pitch.value()), cp = cosDegrees(a.pitch.value());
  const Quad sr = sinDegrees(a.roll.value()), cr = cosDegrees(a.roll.value());
  const Quad3 forward{sh * cp, ch * cp, sp}, right{ch, -sh, 0}, up = cross(right, forward);
  return {{right * cr - up * sr, up * cr + right * sr, forward * -1}};
}

Attitude randomAttitude(std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  Attitude a{Degrees{180 * unit(random)}, Degrees{90 * unit(random)}, Degrees{180 * unit(random)}};
  if (unit(random) > 0.5)
    a.pitch = Degrees{std::copysign(90 - std::pow(10, -16 * std::abs(unit(random))), unit(random))};
  if (unit(random) > 0.8) a.pitch = Degrees{std::copysign(90, unit(random))};
  if (unit(random) > 0.8) a.roll = Degrees{180};
  return a;
}

TEST(AngleStress, attitudesBecomeAxes) {
  std::mt19937_64 random(14);
  Case axes("angles", "eye axes at any attitude and place", 40 * kU, "rad",
            "three rotations of sines and cosines good to 1.6 roundings each: forty in all");
  for (std::size_t i = 0; i < samples(20000); ++i) {
    const GeodeticPosition origin = randomPlace(random), place = randomPlace(random);
    const Attitude a = randomAttitude(random);
    const Mat3 ours = eyeAxes(LocalFrame(origin), place, a);
    const Quad3x3 eye = axesTwin(a), here = eastNorthUpTwin(place.latitude.value(), place.longitude.value());
    const Quad3x3 home = eastNorthUpTwin(origin.latitude.value(), origin.longitude.value());
    for (std::size_t k = 0; k < 3; ++k) {
      const Quad3 e = eye.row[k];
      const Quad3 ecef = here.row[0] * e.x + here.row[1] * e.y + here.row[2] * e.z;
      axes.see(distance(ours.row[k], home * ecef));
    }
  }
}

TEST(AngleStress, theLineOfSightIsTheHeadOnTheAircraft) {
  std::mt19937_64 random(15);
  std::uniform_real_distribution<double> unit(-1, 1);
  Case usual(
      "angles", "line of sight", 64 * kU, "rad",
      "two products of rotations good to 1.6 roundings a sine, three angles of up to pi and their sines");
  Case steep("angles", "line of sight within 1e-12 of the vertical", 0, "violations",
             "taken as vertical: off by its distance from it, and by what any line of sight is");
  for (std::size_t i = 0; i < samples(60000); ++i) {
    Attitude aircraft = randomAttitude(random), head = randomAttitude(random);
    if (i % 3 == 0) {  // up to the vertical and past it
      aircraft.roll = head.heading = Degrees{0};
      aircraft.pitch = Degrees{45};
      head.pitch =
          Degrees{45 + std::pow(10, -2 - 12 * std::abs(unit(random))) * std::copysign(1, unit(random))};
    }
    const Quad3x3 ours = axesTwin(lineOfSight(aircraft, head));
    // Both are right, up, backward: the head's in the aircraft's, whose own are north = ahead, east = right.
    const Quad3x3 body = axesTwin(aircraft), look = axesTwin(head);
    double worst = 0;
    Quad up = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      // The head's east, north, up are the body's right, ahead, up.
      const Quad3 v = look.row[k], exact = body.row[0] * v.x - body.row[2] * v.y + body.row[1] * v.z;
      if (k == 2) up = fabsq(exact.z);
      worst = std::max(worst, toDouble(length(ours.row[k] - exact)));
    }
    const auto where = [&] {
      return digits(aircraft.heading.value()) + ' ' + digits(aircraft.pitch.value()) + ' ' +
             digits(aircraft.roll.value()) + " / " + digits(head.heading.value()) + ' ' +
             digits(head.pitch.value()) + ' ' + digits(head.roll.value());
    };
    const Quad level = sqrtq(std::max<Quad>(0, 1 - up * up));
    if (level < 1.001e-12)
      steep.require(worst <= 1.001e-12 + 64 * kU, where);
    else
      usual.see(worst, where);
  }
}

}  // namespace
}  // namespace trimtab::stress
