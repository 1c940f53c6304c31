#include "circuit.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "point_mass.h"

namespace trimtab::flights {
namespace {

constexpr double kDegree = std::numbers::pi / 180, kFoot = 0.3048;
constexpr double kCentreLatitude = 36.63, kCentreLongitude = 128.35;
constexpr double kFieldM = 354 * kFoot + 2.5;                  ///< the pilot's eye above a runway 354 ft high
constexpr double kRunwayHeading = 280, kRunwayStartM = -1200;  ///< along the runway from the centre

struct Aircraft : PointMass {
  double east() const {
    return (longitude - kCentreLongitude) * 111320 * std::cos(kCentreLatitude * kDegree);
  }
  double north() const { return (latitude - kCentreLatitude) * 110960; }
  /// Metres past the centre in the runway's direction, and right of its line.
  double along() const {
    return east() * std::sin(kRunwayHeading * kDegree) + north() * std::cos(kRunwayHeading * kDegree);
  }
  double right() const {
    return east() * std::cos(kRunwayHeading * kDegree) - north() * std::sin(kRunwayHeading * kDegree);
  }
};

double bankTo(const Aircraft& a, double heading, double limit) {
  return std::clamp(1.3 * wrapped(heading - a.track), -limit, limit);
}
double pathTo(const Aircraft& a, double height, double limit) {
  return std::clamp(0.06 * (height - a.height), -limit, limit);
}
/// Bank onto the runway's line and along it.
double bankToLine(const Aircraft& a) {
  return bankTo(a, kRunwayHeading - std::clamp(a.right() / 30, -90.0, 90.0), 30);
}

/// The pilot: one phase after another, each until its condition is met.
class Pilot {
 public:
  Command command(const Aircraft& a, double time) {
    while (finished(a, time)) {
      ++phase_;
      entered_ = time;
      enteredTrack_ = a.track;
    }
    switch (phase_) {
      case brakes:
        return {0, 0, 0};
      case run:
        return {0, 0, 110};
      case climbAhead:
        return {bankTo(a, kRunwayHeading, 20), 11, 145};
      case climbingTurn:
        return {turned(a) < 120 ? 45 : bankTo(a, downwind, 45), 11, 150};
      case pickUpSpeed:
        return {bankTo(a, downwind, 25), 3, 195};
      case zoom:
        return {bankTo(a, downwind, 25), 31, 190};
      case cruise:
        return {bankTo(a, downwind, 25), pathTo(a, 9000 * kFoot, 9), 155};
      case steepLeft:
        return {-60, pathTo(a, 9000 * kFoot, 6), 155};
      case descend:
        return {bankTo(a, downwind, 25), std::max(-13.0, pathTo(a, 5500 * kFoot, 13)), 150};
      case steepRight:
        return {60, pathTo(a, 5500 * kFoot, 6), 150};
      case descendToBase:
        return {bankTo(a, downwind, 25), pathTo(a, 1900 * kFoot, 12), 125};
      case base:
        return {bankToLine(a), pathTo(a, 1900 * kFoot, 10), 95};
      case approach: {
        const double slope = kFieldM + 15 - (a.along() + 1000) * std::tan(3 * kDegree);
        return {bankToLine(a), std::clamp(-3 + 0.06 * (slope - a.height), -6.0, 0.0), 76};
      }
      default:
        return {bankTo(a, kRunwayHeading, 20), 9, 110};
    }
  }

 private:
  enum Phase {
    brakes,
    run,
    climbAhead,
    climbingTurn,
    pickUpSpeed,
    zoom,
    cruise,
    steepLeft,
    descend,
    steepRight,
    descendToBase,
    base,
    approach,
    goAround
  };
  static constexpr double downwind = kRunwayHeading - 180;

  double turned(const Aircraft& a) const { return std::abs(a.track - enteredTrack_); }

  bool finished(const Aircraft& a, double time) const {
    constexpr double kLead = 12;  ///< degrees of turn that rolling out takes
    switch (phase_) {
      case brakes:
        return time >= 3;
      case run:
        return a.airborne;
      case climbAhead:
        return a.height > 1500 * kFoot;
      case climbingTurn:
        return turned(a) > 170;
      case pickUpSpeed:
        return a.height > 6700 * kFoot && a.speed > 172;
      case zoom:
        return a.height > 8250 * kFoot;
      case cruise:
        return time > entered_ + 45 && std::abs(a.height - 9000 * kFoot) < 5;
      case steepLeft:
        return turned(a) > 360 - kLead;
      case descend:
        return std::abs(a.height - 5500 * kFoot) < 5;
      case steepRight:
        return turned(a) > 360 - kLead;
      case descendToBase:
        return a.along() < -10500;
      case base:
        return std::abs(a.right()) < 150 &&
               a.height > kFieldM + 15 - (a.along() + 1000) * std::tan(3 * kDegree);
      case approach:
        return a.height < kFieldM + 60;
      case goAround:
        return false;
    }
    return false;
  }

  int phase_ = brakes;
  double entered_ = 0, enteredTrack_ = kRunwayHeading;
};

}  // namespace

std::vector<CircuitRow> circuit() {
  Aircraft aircraft;
  aircraft.height = kFieldM;
  aircraft.track = kRunwayHeading;
  aircraft.latitude = kCentreLatitude + kRunwayStartM * std::cos(kRunwayHeading * kDegree) / 110960;
  aircraft.longitude = kCentreLongitude + kRunwayStartM * std::sin(kRunwayHeading * kDegree) /
                                              (111320 * std::cos(kCentreLatitude * kDegree));
  Pilot pilot;
  const int rows = static_cast<int>(std::lround(kCircuitSeconds / kCircuitStep)) + 1;
  const int stepsPerRow = static_cast<int>(std::lround(kCircuitStep / kStep));
  std::vector<CircuitRow> flight;
  for (int row = 0; row < rows; ++row) {
    const double time = row * kCircuitStep;
    flight.push_back({time,
                      {Degrees{aircraft.latitude}, Degrees{aircraft.longitude}, Metres{aircraft.height}},
                      attitudeOf(aircraft)});
    for (int i = 0; i < stepsPerRow; ++i) advance(aircraft, pilot.command(aircraft, time + i * kStep));
  }
  return flight;
}

std::string circuitCsv(const std::vector<CircuitRow>& rows) {
  std::string text = "time_s,latitude_deg,longitude_deg,altitude_ft,pitch_deg,roll_deg,heading_deg\n";
  for (const CircuitRow& row : rows) {
    char line[160];
    const double heading =
        row.attitude.heading.value() < 0 ? row.attitude.heading.value() + 360 : row.attitude.heading.value();
    const int length = std::snprintf(line, sizeof line, "%.1f,%.9f,%.9f,%.3f,%.4f,%.4f,%.4f\n", row.time,
                                     row.position.latitude.value(), row.position.longitude.value(),
                                     row.position.height.value() / kFoot, row.attitude.pitch.value(),
                                     row.attitude.roll.value(), heading);
    text.append(line, static_cast<std::size_t>(length));
  }
  return text;
}

}  // namespace trimtab::flights
