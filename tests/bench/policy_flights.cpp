#include "policy_flights.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "trimtab/scene/data_extent.h"

namespace trimtab::bench {
namespace {

constexpr double kStepS = 0.1, kDegree = std::numbers::pi / 180;
constexpr double kKnot = 1852.0 / 3600, kGravity = 9.81;

struct Track {
  double eastM = 0, northM = 0;
};

/// Metres east and north of the south-western corner, on a plane that is good enough for a degree.
class Plane {
 public:
  explicit Plane(const terrain::Database& terrain)
      : terrain_(terrain), corner_(scene::placeIn(terrain.info(), 0, 0)) {
    const GeodeticPosition far = scene::placeIn(terrain.info(), 1, 1);
    north_ = 110960;
    east_ = 111320 * std::cos((corner_.latitude.value() + far.latitude.value()) / 2 * kDegree);
    widthM_ = (far.longitude.value() - corner_.longitude.value()) * east_;
    heightM_ = (far.latitude.value() - corner_.latitude.value()) * north_;
  }
  Track at(Place p) const { return {p.east * widthM_, p.north * heightM_}; }
  GeodeticPosition place(Track t) const {
    return {Degrees{corner_.latitude.value() + t.northM / north_},
            Degrees{corner_.longitude.value() + t.eastM / east_}, Metres{0}};
  }
  double highest(Track t, double withinM) const {
    const GeodeticPosition p = place(t);
    const auto ground = terrain_.highestWithin(p.latitude, p.longitude, Metres{withinM});
    return ground ? ground->value() : 0;
  }

 private:
  const terrain::Database& terrain_;
  GeodeticPosition corner_;
  double north_ = 1, east_ = 1, widthM_ = 0, heightM_ = 0;
};

/// States from places and heights: the attitude is the velocity's direction, banked as the turn needs it.
Flight flown(const Plane& plane, const std::vector<Track>& track, const std::vector<double>& heightM,
             double alphaDeg, const char* name) {
  Flight flight;
  flight.name = name;
  const auto heading = [&](std::size_t i) {
    const std::size_t a = std::min(i, track.size() - 2);
    return std::atan2(track[a + 1].eastM - track[a].eastM, track[a + 1].northM - track[a].northM) / kDegree;
  };
  for (std::size_t i = 0; i < track.size(); ++i) {
    const std::size_t a = std::min(i, track.size() - 2);
    const double stepM =
        std::hypot(track[a + 1].eastM - track[a].eastM, track[a + 1].northM - track[a].northM);
    const double turn = std::remainder(heading(a + 1) - heading(a), 360.0) / kStepS;
    AircraftState state;
    state.time = static_cast<double>(i) * kStepS;
    state.packet = i;
    state.position = plane.place(track[i]);
    state.position.height = Metres{heightM[i]};
    state.attitude.heading = Degrees{heading(i)};
    state.attitude.pitch =
        Degrees{std::atan2(heightM[a + 1] - heightM[a], std::max(stepM, 1.0)) / kDegree + alphaDeg};
    state.attitude.roll = Degrees{std::atan(stepM / kStepS * turn * kDegree / kGravity) / kDegree};
    flight.states.push_back(state);
  }
  return flight;
}

/// A weave of so many metres to either side of a line, `waves` times.
std::vector<Track> weave(Track from, Track to, double speedMS, double sideM, double waves) {
  const double length = std::hypot(to.eastM - from.eastM, to.northM - from.northM);
  const double eastOf = (to.eastM - from.eastM) / length, northOf = (to.northM - from.northM) / length;
  std::vector<Track> track;
  for (double along = 0; along < length; along += speedMS * kStepS) {
    const double side = sideM * std::sin(2 * std::numbers::pi * waves * along / length);
    track.push_back(
        {from.eastM + along * eastOf + side * northOf, from.northM + along * northOf - side * eastOf});
  }
  return track;
}

/// The mean over so many rows to either side.
std::vector<double> smooth(const std::vector<double>& values, std::ptrdiff_t rows) {
  std::vector<double> result;
  const auto size = static_cast<std::ptrdiff_t>(values.size());
  for (std::ptrdiff_t i = 0; i < size; ++i) {
    double sum = 0;
    for (std::ptrdiff_t k = -rows; k <= rows; ++k)
      sum += values[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(i + k, 0, size - 1))];
    result.push_back(sum / static_cast<double>(2 * rows + 1));
  }
  return result;
}

}  // namespace

Flight lowFlight(const terrain::Database& terrain, Place from, Place to, double clearanceFt) {
  const Plane plane(terrain);
  const auto track = weave(plane.at(from), plane.at(to), 420 * kKnot, 2000, 4);
  std::vector<double> height;
  for (const Track& t : track) height.push_back(plane.highest(t, 1000) + clearanceFt * 0.3048);
  return flown(plane, track, smooth(height, 25), 2, "low");
}

Flight approachFlight(const terrain::Database& terrain, Place touchDown, double headingDeg) {
  constexpr double kPathM = 3000 * 0.3048, kRollOutS = 10, kTurnM = 4000;
  const Plane plane(terrain);
  const Track end = plane.at(touchDown);
  const double ground = plane.highest(end, 300) + 3, speed = 140 * kKnot;
  const double length = kPathM / std::tan(3 * kDegree), heading = headingDeg * kDegree;
  std::vector<Track> track;
  std::vector<double> height;
  for (double along = -length; along < kRollOutS * speed; along += speed * kStepS) {
    // From abeam onto the heading over the first part.
    const double before = std::max(0.0, -along - 0.55 * length) / (0.45 * length);
    const double side = kTurnM * before * before;
    track.push_back({end.eastM + along * std::sin(heading) + side * std::cos(heading),
                     end.northM + along * std::cos(heading) - side * std::sin(heading)});
    height.push_back(ground + std::max(0.0, -along) * std::tan(3 * kDegree));
  }
  return flown(plane, track, smooth(height, 10), 5, "approach");
}

Flight cruiseFlight(const terrain::Database& terrain, Place from, Place to, double altitudeFt) {
  const Plane plane(terrain);
  const auto track = weave(plane.at(from), plane.at(to), 450 * kKnot, 3000, 1.5);
  return flown(plane, track, std::vector<double>(track.size(), altitudeFt * 0.3048), 2.5, "cruise");
}

Flight withHead(const Flight& flight, const HeadLog& log, double beginS) {
  constexpr double kRowS = 0.05;
  Flight with;
  with.name = flight.name + " and head";
  for (double time = flight.beginS(); time < flight.beginS() + flight.durationS(); time += kRowS) {
    AircraftState state = stateAt(flight, time);
    state.head = headAt(log, beginS + time - flight.beginS());
    with.states.push_back(state);
  }
  return with;
}

}  // namespace trimtab::bench
