#include "trimtab/motion/line_of_sight.h"

#include <cmath>

namespace trimtab {
namespace {

/// Body axes (x forward, y right, z down) to north, east, down.
Mat3 bodyToWorld(const Attitude& a) {
  const auto radians = [](Degrees d) { return d.in<Radians>(); };
  const double ch = std::cos(radians(a.heading)), sh = std::sin(radians(a.heading));
  const double cp = std::cos(radians(a.pitch)), sp = std::sin(radians(a.pitch));
  const double cr = std::cos(radians(a.roll)), sr = std::sin(radians(a.roll));
  return {{Vec3{ch * cp, ch * sp * sr - sh * cr, ch * sp * cr + sh * sr},
           Vec3{sh * cp, sh * sp * sr + ch * cr, sh * sp * cr - ch * sr}, Vec3{-sp, cp * sr, cp * cr}}};
}

}  // namespace

Attitude lineOfSight(const Attitude& aircraft, const std::optional<Attitude>& head) {
  if (!head || *head == Attitude{}) return aircraft;
  const Mat3 m = bodyToWorld(aircraft) * bodyToWorld(*head);
  const auto degrees = [](double radians) { return Radians{radians}.as<Degrees>(); };
  const double down = m.row[2].x;
  // Pitch uses the level part as well, because an arcsine alone loses half its digits near the vertical. Roll
  // is counted from the level axis of that heading: both are uncertain there, but not what they make
  // together.
  const double level = std::sqrt(m.row[0].x * m.row[0].x + m.row[1].x * m.row[1].x);
  // Straight up or down, heading and roll turn about one axis.
  if (level < 1e-12)
    return {wrapped360(degrees(std::atan2(-m.row[0].y, m.row[1].y))), Degrees{down < 0 ? 90.0 : -90.0},
            Degrees{0}};
  return {wrapped360(degrees(std::atan2(m.row[1].x, m.row[0].x))), degrees(std::atan2(-down, level)),
          degrees(std::atan2(m.row[1].x * m.row[0].z - m.row[0].x * m.row[1].z,
                             m.row[0].x * m.row[1].y - m.row[1].x * m.row[0].y))};
}

Vec3 directionOf(const Attitude& a) {
  const double heading = a.heading.in<Radians>(), pitch = a.pitch.in<Radians>();
  return {std::sin(heading) * std::cos(pitch), std::cos(heading) * std::cos(pitch), std::sin(pitch)};
}

double degreesBetween(Vec3 a, Vec3 b) {
  return Radians{std::atan2(length(cross(a, b)), dot(a, b))}.as<Degrees>().value();
}

}  // namespace trimtab
