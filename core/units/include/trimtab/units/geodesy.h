#pragma once

#include "trimtab/units/linear.h"
#include "trimtab/units/quantity.h"

/// Converts WGS84 geodetic positions to earth-centred, earth-fixed (ECEF) places and to a local frame, and
/// back; wraps angles.
namespace trimtab {

struct GeodeticPosition {
  Degrees latitude, longitude;  ///< WGS84 geodetic; longitude -180..180
  Metres height;  ///< used as height above the ellipsoid; heights above sea level of hosts and terrain are
                  ///< used alike

  friend bool operator==(const GeodeticPosition&, const GeodeticPosition&) = default;
};

/// The attitude of an aircraft or a view: true heading, clockwise from north; pitch, nose up positive; roll,
/// right wing down positive.
struct Attitude {
  Degrees heading, pitch, roll;

  friend bool operator==(const Attitude&, const Attitude&) = default;
};

Vec3 toEcef(const GeodeticPosition& position);
/// Is the inverse of toEcef, to below 10 nm within 1,000 km of the surface. Use it for places farther than
/// 1,000 km from the earth's centre; the centre itself gives the north pole.
GeodeticPosition toGeodetic(Vec3 ecef);

/// Returns east, north and up at a position, as the rows of a rotation from ECEF.
Mat3 eastNorthUp(Degrees latitude, Degrees longitude);

/// The frame of a terrain: metres east (x), north (y) and up (z) of its origin. It is an isometry of ECEF, so
/// the earth stays curved in it.
class LocalFrame {
 public:
  LocalFrame() : LocalFrame(GeodeticPosition{}) {}
  explicit LocalFrame(const GeodeticPosition& origin);
  const GeodeticPosition& origin() const { return origin_; }
  Vec3 fromEcef(Vec3 ecef) const { return rotation_ * (ecef - originEcef_); }
  Vec3 toEcef(Vec3 local) const { return transposed(rotation_) * local + originEcef_; }
  Vec3 fromGeodetic(const GeodeticPosition& p) const { return fromEcef(trimtab::toEcef(p)); }
  GeodeticPosition toGeodetic(Vec3 local) const { return trimtab::toGeodetic(toEcef(local)); }
  const Mat3& ecefToLocal() const { return rotation_; }

 private:
  GeodeticPosition origin_;
  Vec3 originEcef_;
  Mat3 rotation_;
};

/// Returns the rotation from `frame` to the axes of an eye with an attitude at a position: x right, y up, -z
/// forward, as OpenGL's.
Mat3 eyeAxes(const LocalFrame& frame, const GeodeticPosition& position, const Attitude& attitude);

/// Returns the same direction in -180..180; NaN for NaN and infinities.
Degrees wrapped180(Degrees angle);
/// Returns the same direction in 0..360.
Degrees wrapped360(Degrees angle);

}  // namespace trimtab
