#include "dead_reckoning.h"

#include <algorithm>
#include <cmath>

#include "trimtab/host/motion.h"

namespace trimtab {
namespace {

/// Returns north, east and down at a place, as the rows of a rotation from ECEF.
Mat3 northEastDown(const GeodeticPosition& position) {
  const Mat3 enu = eastNorthUp(position.latitude, position.longitude);
  return {{enu.row[1], enu.row[0], -enu.row[2]}};
}

/// What a turn at the rate `w` (rad/s, about body axes) does in `t` seconds, for a vector that is given in
/// the turning axes: where it points in the axes of the beginning, and the integrals of that and of that
/// times the elapsed time. IEEE 1278.1 (Annex E) calls the integrals R1 and R2.
struct Turning {
  Turning(Vec3 w, double t) : axis_(w) {
    const double rate = length(w), a = rate * t;
    // Closed forms lose their digits for small angles; there, the first terms of the series are exact.
    constexpr double kSmall = 1e-3;
    if (std::abs(a) < kSmall) {
      const double a2 = a * a;
      turned_ = {1 - a2 / 2, t * (1 - a2 / 6), t * t * (0.5 - a2 / 24)};
      integral_ = {t * (1 - a2 / 6), t * t * (0.5 - a2 / 24), t * t * t * (1.0 / 6 - a2 / 120)};
      second_ = {t * t * (0.5 - a2 / 8), t * t * t * (1.0 / 3 - a2 / 30), t * t * t * t * (0.125 - a2 / 144)};
      return;
    }
    const double s = std::sin(a), c = std::cos(a), r2 = rate * rate;
    turned_ = {c, s / rate, (1 - c) / r2};
    integral_ = {s / rate, (1 - c) / r2, (a - s) / (r2 * rate)};
    second_ = {(c + a * s - 1) / r2, (s - a * c) / (r2 * rate), (a * a / 2 - c - a * s + 1) / (r2 * r2)};
  }
  Vec3 turned(Vec3 v) const { return apply(turned_, v); }
  Vec3 integral(Vec3 v) const { return apply(integral_, v); }
  Vec3 secondIntegral(Vec3 v) const { return apply(second_, v); }

 private:
  /// Factors of the vector, of its cross product with the axis, and of its part along the axis.
  struct Factors {
    double along = 0, across = 0, axial = 0;
  };
  Vec3 apply(const Factors& f, Vec3 v) const {
    return v * f.along + cross(axis_, v) * f.across + axis_ * (dot(axis_, v) * f.axial);
  }
  Vec3 axis_;
  Factors turned_, integral_, second_;
};

}  // namespace

Mat3 bodyAxes(Radians psi, Radians theta, Radians phi) {
  const double sp = std::sin(psi.value()), cp = std::cos(psi.value()), st = std::sin(theta.value()),
               ct = std::cos(theta.value()), sf = std::sin(phi.value()), cf = std::cos(phi.value());
  return {{Vec3{ct * cp, ct * sp, -st}, Vec3{sf * st * cp - cf * sp, sf * st * sp + cf * cp, sf * ct},
           Vec3{cf * st * cp + sf * sp, cf * st * sp - sf * cp, cf * ct}}};
}

Mat3 ecefToBody(const GeodeticPosition& position, const Attitude& attitude) {
  return bodyAxes(attitude.heading.as<Radians>(), attitude.pitch.as<Radians>(), attitude.roll.as<Radians>()) *
         northEastDown(position);
}

Attitude attitudeOf(const GeodeticPosition& position, const Mat3& ecefToBody) {
  const Mat3 body = ecefToBody * transposed(northEastDown(position));
  const Vec3 forward = body.row[0], right = body.row[1], down = body.row[2];
  const Radians pitch{std::asin(std::clamp(-forward.z, -1.0, 1.0))};
  constexpr double kVertical = 1e-9;
  const bool vertical = std::hypot(forward.x, forward.y) < kVertical;
  const Radians heading{vertical ? std::atan2(-right.x, right.y) : std::atan2(forward.y, forward.x)};
  const Radians roll{vertical ? 0 : std::atan2(right.z, down.z)};
  return {wrapped360(heading.as<Degrees>()), pitch.as<Degrees>(), wrapped180(roll.as<Degrees>())};
}

Velocity overGround(const GeodeticPosition& position, Vec3 ecef) {
  const Vec3 v = northEastDown(position) * ecef;
  return {MetresPerSecond{v.x}, MetresPerSecond{v.y}, MetresPerSecond{v.z}};
}

double longestGapS(const AircraftState& state) {
  // A host of DIS sends at least every 5 s, and is given up after 2.4 times that (IEEE 1278.1, Annex B).
  constexpr double kHeartbeatS = 5, kMultiplier = 2.4;
  return state.deadReckoning ? kHeartbeatS * kMultiplier : kSilenceS;
}

AircraftState deadReckoned(const AircraftState& state, double seconds) {
  AircraftState moved = state;
  moved.time += seconds;
  if (!state.deadReckoning || seconds == 0) return moved;
  const DeadReckoning& d = *state.deadReckoning;
  const Mat3 body = ecefToBody(state.position, state.attitude), fromBody = transposed(body);
  const Turning turning(d.rotates ? d.angularVelocity : Vec3{}, seconds);
  const Vec3 way = d.inBodyAxes
                       ? fromBody * (turning.integral(d.velocity) + turning.secondIntegral(d.acceleration))
                       : d.velocity * seconds + d.acceleration * (seconds * seconds / 2);
  moved.position = toGeodetic(toEcef(state.position) + way);
  // The axes after the turn, each given in those before it.
  const Mat3 now{{fromBody * turning.turned({1, 0, 0}), fromBody * turning.turned({0, 1, 0}),
                  fromBody * turning.turned({0, 0, 1})}};
  moved.attitude = attitudeOf(moved.position, now);
  return moved;
}

}  // namespace trimtab
