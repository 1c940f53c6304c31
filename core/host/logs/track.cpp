#include "track.h"

#include <algorithm>
#include <cmath>

#include "trimtab/host/motion.h"
#include "trimtab/units/geodesy.h"

namespace trimtab {
namespace {

constexpr double kSmoothS = 1, kGravity = 9.80665, kMostBankDeg = 80;

struct Leg {
  double distance = 0, climb = 0, seconds = 0;
  std::optional<Degrees> course;
};

Leg legBetween(const AircraftState& a, const AircraftState& b) {
  GeodeticPosition level = b.position;
  level.height = a.position.height;
  return {distanceM(a.position, level), (b.position.height - a.position.height).value(), b.time - a.time,
          course(a.position, b.position)};
}

}  // namespace

std::optional<Degrees> course(const GeodeticPosition& a, const GeodeticPosition& b) {
  GeodeticPosition level = b;
  level.height = a.height;
  const Vec3 move = eastNorthUp(a.latitude, a.longitude) * (toEcef(level) - toEcef(a));
  if (!(std::hypot(move.x, move.y) >= 1)) return std::nullopt;
  return wrapped360(Radians{std::atan2(move.x, move.y)}.as<Degrees>());
}

void setAttitudeFromTrack(std::vector<AircraftState>& states, bool heading) {
  Degrees lastCourse{}, lastPitch{}, lastRoll{};
  bool known = false;
  std::size_t from = 0, to = 0;
  std::vector<Leg> legs(states.size());
  for (std::size_t i = 0; i < states.size(); ++i) {
    // The leg around a row reaches half the smoothing to either side, and at least to the next row.
    while (from + 1 < i && states[i].time - states[from + 1].time >= kSmoothS / 2) ++from;
    to = std::max(to, std::min(i + 1, states.size() - 1));
    while (to + 1 < states.size() && states[to].time - states[i].time < kSmoothS / 2) ++to;
    legs[i] = legBetween(states[from], states[to]);
  }
  const auto first =
      std::find_if(legs.begin(), legs.end(), [](const Leg& leg) { return leg.course.has_value(); });
  if (first != legs.end()) lastCourse = *first->course;
  for (std::size_t i = 0; i < states.size(); ++i) {
    const Leg& leg = legs[i];
    if (leg.course && leg.seconds > 0) {
      lastPitch = Radians{std::atan2(leg.climb, leg.distance)}.as<Degrees>();
      const double turn = known ? wrapped180(*leg.course - lastCourse).value() : 0;
      const double step = i > 0 ? states[i].time - states[i - 1].time : 0;
      if (step > 0) {
        const double rate = Degrees{turn / step}.in<Radians>(), speed = leg.distance / leg.seconds;
        const double bank = Radians{std::atan(speed * rate / kGravity)}.in<Degrees>();
        lastRoll = Degrees{std::clamp(bank, -kMostBankDeg, kMostBankDeg)};
      }
      lastCourse = *leg.course;
      known = true;
    }
    states[i].attitude.pitch = lastPitch;
    states[i].attitude.roll = lastRoll;
    if (heading) states[i].attitude.heading = lastCourse;
  }
}

std::optional<double> headingErrorDeg(const std::vector<AircraftState>& states, double scale) {
  double sum = 0;
  std::size_t count = 0, last = 0;
  for (std::size_t i = 1; i < states.size(); ++i) {
    const auto between = course(states[last].position, states[i].position);
    if (!between) continue;
    sum += std::abs(wrapped180(states[last].attitude.heading * scale - *between).value());
    last = i;
    ++count;
  }
  if (count == 0) return std::nullopt;
  return sum / static_cast<double>(count);
}

}  // namespace trimtab
