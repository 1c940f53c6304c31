#include "trimtab/units/geodesy.h"

#include <cmath>

namespace trimtab {
namespace {

constexpr double kA = 6378137.0;          // WGS84 semi-major axis, m
constexpr double kF = 1 / 298.257223563;  // flattening
constexpr double kB = kA * (1 - kF);      // semi-minor axis, m
constexpr double kE2 = kF * (2 - kF);     // first eccentricity squared
constexpr double kEp2 = kE2 / (1 - kE2);  // second eccentricity squared

struct SinCos {
  double sin, cos;
};
SinCos sinCos(Degrees angle) {
  // Reduced to a quarter turn first: 90 degrees then has a cosine of exactly 0, and a pole stays a point.
  int quarter = 0;
  const double r = std::remquo(angle.value(), 90.0, &quarter) * unit::Degree::size;
  const double s = std::sin(r), c = std::cos(r);
  switch (quarter & 3) {
    case 0:
      return {s, c};
    case 1:
      return {c, -s};
    case 2:
      return {-s, -c};
    default:
      return {-c, s};
  }
}

}  // namespace

Vec3 toEcef(const GeodeticPosition& p) {
  const auto [sinLat, cosLat] = sinCos(p.latitude);
  const auto [sinLon, cosLon] = sinCos(p.longitude);
  const double n = kA / std::sqrt(1 - kE2 * sinLat * sinLat);
  const double h = p.height.value();
  return {(n + h) * cosLat * cosLon, (n + h) * cosLat * sinLon, (n * (1 - kE2) + h) * sinLat};
}

GeodeticPosition toGeodetic(Vec3 e) {
  const double p = std::hypot(e.x, e.y);
  // Bowring's iteration on the reduced latitude: quadratic in e^2, so three steps reach the last bit within
  // 1,000 km of the surface; the loop ends at the fixed point.
  double sinB = e.z, cosB = (1 - kF) * p;
  double sinLat = 0, cosLat = 1;
  for (int i = 0; i < 12; ++i) {
    const double rb = std::hypot(sinB, cosB);
    if (rb == 0) return {Degrees{90}, Degrees{0}, Metres{-kB}};
    sinB /= rb;
    cosB /= rb;
    const double z = e.z + kEp2 * kB * sinB * sinB * sinB;
    const double q = p - kE2 * kA * cosB * cosB * cosB;
    const double r = std::hypot(z, q);
    const double newSin = z / r, newCos = q / r;
    const bool settled = std::abs(newSin - sinLat) + std::abs(newCos - cosLat) < 1e-16;
    sinLat = newSin;
    cosLat = newCos;
    if (settled) break;
    sinB = (1 - kF) * sinLat;
    cosB = cosLat;
  }
  // This form of the height is stable from the equator to the pole: no division by a small sine or cosine.
  const double height = p * cosLat + e.z * sinLat - kA * std::sqrt(1 - kE2 * sinLat * sinLat);
  return {Radians{std::atan2(sinLat, cosLat)}.as<Degrees>(), Radians{std::atan2(e.y, e.x)}.as<Degrees>(),
          Metres{height}};
}

Mat3 eastNorthUp(Degrees latitude, Degrees longitude) {
  const auto [sinLat, cosLat] = sinCos(latitude);
  const auto [sinLon, cosLon] = sinCos(longitude);
  return {{Vec3{-sinLon, cosLon, 0}, Vec3{-sinLat * cosLon, -sinLat * sinLon, cosLat},
           Vec3{cosLat * cosLon, cosLat * sinLon, sinLat}}};
}

LocalFrame::LocalFrame(const GeodeticPosition& origin)
    : origin_(origin),
      originEcef_(trimtab::toEcef(origin)),
      rotation_(eastNorthUp(origin.latitude, origin.longitude)) {}

Mat3 eyeAxes(const LocalFrame& frame, const GeodeticPosition& position, const Attitude& attitude) {
  const auto [sinH, cosH] = sinCos(attitude.heading);
  const auto [sinP, cosP] = sinCos(attitude.pitch);
  const auto [sinR, cosR] = sinCos(attitude.roll);
  const Vec3 forward{sinH * cosP, cosH * cosP, sinP};
  const Vec3 levelRight{cosH, -sinH, 0};
  const Vec3 levelUp = cross(levelRight, forward);
  const Mat3 eyeFromEnu{{levelRight * cosR - levelUp * sinR, levelUp * cosR + levelRight * sinR, -forward}};
  const Mat3 enuFromFrame =
      eastNorthUp(position.latitude, position.longitude) * transposed(frame.ecefToLocal());
  return eyeFromEnu * enuFromFrame;
}

Degrees wrapped180(Degrees angle) {
  return Degrees{std::remainder(angle.value(), 360.0)};
}

Degrees wrapped360(Degrees angle) {
  double r = std::fmod(angle.value(), 360.0);
  if (r < 0) r += 360.0;
  return Degrees{r == 360.0 ? 0.0 : r};
}

}  // namespace trimtab
