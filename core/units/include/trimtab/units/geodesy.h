#pragma once

#include "trimtab/units/linear.h"
#include "trimtab/units/quantity.h"

/// WGS84: geodetic <-> earth-centred earth-fixed (ECEF) <-> a local frame, and angles that wrap.
namespace trimtab {

struct GeodeticPosition {
  Degrees latitude, longitude;  ///< WGS84 geodetic; longitude -180..180
  Metres height;  ///< placed as ellipsoid height; hosts' and terrains' mean sea level heights are used alike

  friend bool operator==(const GeodeticPosition&, const GeodeticPosition&) = default;
};

/// Aircraft or view attitude: heading true, clockwise from north; pitch nose up positive; roll right wing
/// down positive.
struct Attitude {
  Degrees heading, pitch, roll;

  friend bool operator==(const Attitude&, const Attitude&) = default;
};

Vec3 toEcef(const GeodeticPosition& position);
/// Inverse of toEcef, to below 10 nm within 1,000 km of the surface; meant for positions farther than 1,000
/// km from the earth's centre. The centre itself gives the north pole.
GeodeticPosition toGeodetic(Vec3 ecef);

/// East, north and up at a position as the rows of a rotation from ECEF.
Mat3 eastNorthUp(Degrees latitude, Degrees longitude);

/// The frame a terrain lives in: metres east (x), north (y) and up (z) of its origin, by an isometry of ECEF:
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

/// Rotation from `frame` to the eye's axes, x right, y up, -z forward (OpenGL's), for an attitude at a
/// position.
Mat3 eyeAxes(const LocalFrame& frame, const GeodeticPosition& position, const Attitude& attitude);

/// The same direction in -180..180; NaN and infinities come back as NaN.
Degrees wrapped180(Degrees angle);
/// The same direction in 0..360.
Degrees wrapped360(Degrees angle);

}  // namespace trimtab
