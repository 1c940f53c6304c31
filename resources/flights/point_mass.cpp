#include "point_mass.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace trimtab::flights {
namespace {

constexpr double kDegree = std::numbers::pi / 180, kGravity = 9.81;
constexpr double kLiftOffMps = 77, kRotateMps = 62;
constexpr double kLiftOffAlpha = 8;  ///< angle of attack that carries the aircraft at kLiftOffMps, degrees

/// A second-order filter without overshoot, its rate limited.
void follow(double command, double frequency, double lowestRate, double highestRate, double& value,
            double& rate) {
  rate += kStep * (frequency * frequency * (command - value) - 2 * frequency * rate);
  rate = std::clamp(rate, lowestRate, highestRate);
  value += kStep * rate;
}

}  // namespace

double wrapped(double degrees) {
  return std::remainder(degrees, 360.0);
}

void advance(PointMass& a, const Command& c) {
  a.acceleration += kStep * (std::clamp(0.15 * (c.speed - a.speed), -2.5, 3.0) - a.acceleration);
  a.speed = std::max(0.0, a.speed + kStep * a.acceleration);
  if (!a.airborne) {
    a.airborne = a.speed >= kLiftOffMps;
  } else {
    follow(c.bank, 1.4, -30, 30, a.bank, a.bankRate);
    // Between 0.2 and 2.2 g across the path.
    const double perG = kGravity / a.speed / kDegree, level = std::cos(a.path * kDegree);
    follow(c.path, 0.8, (0.2 - level) * perG, (2.2 - level) * perG, a.path, a.pathRate);
    a.track += kStep * kGravity * std::tan(a.bank * kDegree) / (a.speed * level) / kDegree;
  }
  const double flat = 6378137.0 * (1 - 0.00669438), sine = std::sin(a.latitude * kDegree);
  const double w = std::sqrt(1 - 0.00669438 * sine * sine);
  const double forward = kStep * a.speed * std::cos(a.path * kDegree);
  a.latitude += forward * std::cos(a.track * kDegree) / (flat / (w * w * w) + a.height) / kDegree;
  a.longitude += forward * std::sin(a.track * kDegree) /
                 ((6378137.0 / w + a.height) * std::cos(a.latitude * kDegree)) / kDegree;
  a.height += kStep * a.speed * std::sin(a.path * kDegree);
}

Attitude attitudeOf(const PointMass& a) {
  if (!a.airborne) {
    const double x = std::clamp((a.speed - kRotateMps) / (kLiftOffMps - kRotateMps), 0.0, 1.0);
    return {Degrees{wrapped(a.track)}, Degrees{kLiftOffAlpha * x * x * (3 - 2 * x)}, Degrees{0}};
  }
  const double path = a.path * kDegree, track = a.track * kDegree, bank = a.bank * kDegree;
  const double load = (std::cos(path) + a.pathRate * kDegree * a.speed / kGravity) / std::cos(bank);
  const double alpha = kLiftOffAlpha * load * kLiftOffMps * kLiftOffMps / (a.speed * a.speed) * kDegree;
  const Vec3 along{std::cos(path) * std::sin(track), std::cos(path) * std::cos(track), std::sin(path)};
  const Vec3 above{-std::sin(path) * std::sin(track), -std::sin(path) * std::cos(track), std::cos(path)};
  const Vec3 right{std::cos(track), -std::sin(track), 0};
  const Vec3 lift = above * std::cos(bank) + right * std::sin(bank);
  const Vec3 wing = right * std::cos(bank) - above * std::sin(bank);
  const Vec3 nose = along * std::cos(alpha) + lift * std::sin(alpha);
  const Vec3 top = lift * std::cos(alpha) - along * std::sin(alpha);
  return {Degrees{std::atan2(nose.x, nose.y) / kDegree}, Degrees{std::asin(nose.z) / kDegree},
          Degrees{std::atan2(-wing.z, top.z) / kDegree}};
}

}  // namespace trimtab::flights
