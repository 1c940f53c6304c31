#include "route.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "point_mass.h"

namespace trimtab::flights {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

struct WayPoint {
  double latitude, longitude, heightM;
};

struct Route {
  std::span<const WayPoint> points;
  double speed;    ///< metres a second
  double aheadM;   ///< how far ahead of its place on the route the pilot aims
  double bankMax;  ///< degrees
};

/// A route on a plane that touches the ground at its first point; a few tens of kilometres long.
class Guide {
 public:
  explicit Guide(const Route& route) : route_(route) {
    const WayPoint& origin = route.points.front();
    for (const WayPoint& p : route.points)
      line_.push_back({(p.longitude - origin.longitude) * 111320 * std::cos(origin.latitude * kDegree),
                       (p.latitude - origin.latitude) * 110960, p.heightM});
    for (std::size_t i = 0; i + 1 < line_.size(); ++i)
      length_.push_back(std::hypot(line_[i + 1].x - line_[i].x, line_[i + 1].y - line_[i].y));
  }

  PointMass start() const {
    PointMass aircraft;
    aircraft.airborne = true;
    aircraft.latitude = route_.points[0].latitude;
    aircraft.longitude = route_.points[0].longitude;
    aircraft.height = route_.points[0].heightM;
    aircraft.speed = route_.speed;
    aircraft.track = std::atan2(line_[1].x - line_[0].x, line_[1].y - line_[0].y) / kDegree;
    aircraft.path = slope();
    return aircraft;
  }
  bool finished() const { return leg_ + 1 >= line_.size(); }

  Command command(const PointMass& a) {
    const WayPoint& origin = route_.points.front();
    const double x = (a.longitude - origin.longitude) * 111320 * std::cos(origin.latitude * kDegree),
                 y = (a.latitude - origin.latitude) * 110960;
    // The place on the route never goes back: a route may cross itself.
    while (!finished()) {
      const Vec3 from = line_[leg_], to = line_[leg_ + 1];
      along_ =
          std::max(along_, ((x - from.x) * (to.x - from.x) + (y - from.y) * (to.y - from.y)) / length_[leg_]);
      if (along_ < length_[leg_]) break;
      ++leg_;
      along_ = 0;
    }
    if (finished()) return {0, 0, route_.speed};
    const Vec3 aim = at(route_.aheadM), here = at(0);
    const double bearing = std::atan2(aim.x - x, aim.y - y) / kDegree;
    return {std::clamp(2.2 * wrapped(bearing - a.track), -route_.bankMax, route_.bankMax),
            std::clamp(std::atan2(at(kLead).z - here.z, kLead) / kDegree + 0.04 * (here.z - a.height), -20.0,
                       20.0),
            route_.speed};
  }

 private:
  static constexpr double kSteepest = 30;  ///< degrees of path, either way
  static constexpr double kLead = 400;     ///< metres over which the route's slope is taken

  double slope() const { return std::atan2(at(kLead).z - at(0).z, kLead) / kDegree; }

  /// So many metres on along the route; beyond its end straight on.
  Vec3 at(double ahead) const {
    std::size_t leg = leg_;
    double along = along_ + ahead;
    while (leg + 2 < line_.size() && along > length_[leg]) along -= length_[leg++];
    const double t = along / length_[leg];
    return line_[leg] + (line_[leg + 1] - line_[leg]) * t;
  }

  const Route& route_;
  std::vector<Vec3> line_;
  std::vector<double> length_;
  std::size_t leg_ = 0;
  double along_ = 0;
};

std::vector<CircuitRow> fly(const Route& route) {
  Guide guide(route);
  PointMass aircraft = guide.start();
  const int stepsPerRow = static_cast<int>(std::lround(kCircuitStep / kStep));
  std::vector<CircuitRow> flight;
  for (int row = 0; !guide.finished(); ++row) {
    flight.push_back({row * kCircuitStep,
                      {Degrees{aircraft.latitude}, Degrees{aircraft.longitude}, Metres{aircraft.height}},
                      attitudeOf(aircraft)});
    for (int i = 0; i < stepsPerRow; ++i) advance(aircraft, guide.command(aircraft));
  }
  return flight;
}

// Way points: the valley floor's height and what the aircraft keeps above it and above the slopes beside it.
constexpr WayPoint kKansai[] = {
    {35.3200, 135.8958, 400},  {35.3000, 135.8870, 420},  {35.2800, 135.8792, 450},
    {35.2600, 135.8725, 480},  {35.2400, 135.8650, 530},  {35.2200, 135.8600, 660},
    {35.2000, 135.8590, 700},  {35.1800, 135.8575, 680},  {35.1608, 135.8525, 610},
    {35.1408, 135.8367, 520},  {35.1208, 135.8292, 450},  {35.1008, 135.8242, 430},
    {35.0808, 135.8183, 450},  {35.0617, 135.8017, 600},  {35.0450, 135.7850, 850},
    {35.0350, 135.8200, 1450}, {35.0500, 135.8600, 1840}, {35.0700, 135.8950, 1840},
    {35.0850, 135.9180, 1800}, {35.1080, 135.9430, 700},  {35.1250, 135.9600, 420},
    {35.1400, 135.9720, 400}};

constexpr WayPoint kEverest[] = {
    {27.8130, 86.7350, 5600}, {27.8300, 86.7530, 5000}, {27.8420, 86.7650, 4850}, {27.8560, 86.7950, 4850},
    {27.8750, 86.8120, 5000}, {27.9000, 86.8220, 5250}, {27.9250, 86.8150, 5450}, {27.9450, 86.8180, 5600},
    {27.9650, 86.8280, 5800}, {27.9800, 86.8450, 6150}, {27.9840, 86.8630, 6600}, {27.9800, 86.8800, 7000},
    {27.9760, 86.9000, 7450}, {27.9735, 86.9180, 7950}, {27.9730, 86.9300, 8150}, {27.9720, 86.9500, 8200},
    {27.9580, 86.9660, 8100}, {27.9350, 86.9600, 7000}, {27.9150, 86.9400, 6150}, {27.9030, 86.9100, 5600},
    {27.9000, 86.8800, 5350}, {27.8930, 86.8500, 5150}, {27.8800, 86.8200, 4950}, {27.8660, 86.8000, 6250},
    {27.8550, 86.7850, 6500}};

}  // namespace

std::vector<CircuitRow> kansaiValley() {
  return fly({kKansai, 150, 1000, 50});
}

std::vector<CircuitRow> everestPass() {
  return fly({kEverest, 150, 1200, 55});
}

}  // namespace trimtab::flights
