#include "world.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "trimtab/preset/preset.h"
#include "world_models.h"

namespace trimtab::terrain {

namespace {

/// Metres east and north of the sample's middle.
struct Spot {
  double east = 0, north = 0;
  Spot moved(double bearingDeg, double ahead, double right) const {
    const double turn = bearingDeg * std::numbers::pi / 180;
    return {east + ahead * std::sin(turn) + right * std::cos(turn),
            north + ahead * std::cos(turn) - right * std::sin(turn)};
  }
  double distance(Spot other) const { return std::hypot(east - other.east, north - other.north); }
};

constexpr double kRunwayDeg = 100;  ///< as the shipped flight takes off, the other way
/// Gentler ground is farmed, so woods lie where ridges hide them.
constexpr double kFarmedSlope = 0.05;
constexpr double kMostSlopeOfWood = 0.75, kTreeLineM = 1200, kThinningM = 500;
constexpr double kTreesPerKm2 = 3500, kMostTrees = 195000, kShareWooded = 0.17;
constexpr float kBrookM2 = 1.5e7f;
constexpr double kTownM = 650, kPylonStepM = 300;
constexpr double kRunwayM = 2700, kRunwayWideM = 45;

class Planter {
 public:
  explicit Planter(const WorldGround& ground)
      : ground_(ground), land_(ground.land), half_((land_.side - 1) / 2.0), random_(ground.seed) {}

  std::string planted(const std::string& folder) {
    folder_ = folder;
    text_ = "model,latitude_deg,longitude_deg,height_m,heading_deg,scale\n";
    chooseTown();
    buildAirfield();
    buildTown();
    lightStreets();
    buildPylons();
    plantWoods();
    return std::move(text_);
  }

 private:
  double chance() { return static_cast<double>(random_()) / 4294967296.0; }

  bool within(Spot at) const {
    const double reach = (half_ - 2) * land_.cellM;
    return std::abs(at.east) < reach && std::abs(at.north) < reach;
  }
  std::size_t cellOf(Spot at) const {
    return static_cast<std::size_t>(half_ + at.north / land_.cellM) * land_.side +
           static_cast<std::size_t>(half_ + at.east / land_.cellM);
  }
  /// No corner of a spot's cell is in the sea or a brook.
  bool isDry(Spot at) const {
    const std::size_t i = cellOf(at);
    for (const std::size_t k : {i, i + 1, i + land_.side, i + land_.side + 1})
      if (land_.heights[k] < 0.5f || (land_.drainedM2[k] > kBrookM2 && at.distance({}) > ground_.flatM))
        return false;
    return true;
  }
  double slopeAt(Spot at) const {
    const std::size_t i = cellOf(at);
    const float* h = land_.heights.data();
    const double east = (h[i + 1] + h[i + 1 + land_.side] - h[i] - h[i + land_.side]) / 2,
                 north = (h[i + land_.side] + h[i + 1 + land_.side] - h[i] - h[i + 1]) / 2;
    return std::hypot(east, north) / land_.cellM;
  }

  void put(WorldModel model, Spot at, double headingDeg, double scale = 1) {
    if (!within(at) || !isDry(at)) return;
    text_ += folder_ + "/" + kWorldModelNames[static_cast<std::size_t>(model)] + ".obj";
    number(ground_.posts.latitude(half_ + at.north / land_.cellM), 7);
    number(ground_.posts.longitude(half_ + at.east / land_.cellM), 7);
    text_ += ',';
    number(std::fmod(headingDeg + 360, 360), 0);
    number(scale, 2);
    text_ += '\n';
  }
  void number(double value, int digits) {
    char text[32];
    const auto end = std::to_chars(text, text + sizeof text, value, std::chars_format::fixed, digits).ptr;
    text_ += ',';
    text_.append(text, end);
  }

  /// Looks on rings around the flat, beside the runway's ends, for the gentlest dry ground.
  void chooseTown() {
    double best = 1e9;
    const double reach = (half_ - 2) * land_.cellM - kTownM;
    for (double away = ground_.flatM + 900; away < 2.6 * ground_.flatM + 900; away += 400)
      for (double bearing = 0; bearing < 360; bearing += 7.5) {
        const double turn = bearing * std::numbers::pi / 180;
        const Spot at{away * std::sin(turn), away * std::cos(turn)};
        const double beside = std::abs(std::sin(turn - kRunwayDeg * std::numbers::pi / 180)) * away;
        if (std::max(std::abs(at.east), std::abs(at.north)) > reach || beside < 0.4 * ground_.flatM) continue;
        double unfit = away / 50000;
        for (double e = -600; e <= 600; e += 100)
          for (double n = -600; n <= 600; n += 100) {
            const Spot near{at.east + e, at.north + n};
            unfit += isDry(near) ? slopeAt(near) / 10 : 0.1;
          }
        if (unfit < best) best = unfit, town_ = at;
      }
    streetDeg_ = std::floor(180 * chance());
  }

  void buildAirfield() {
    const auto beside = [](double ahead, double right) { return Spot{}.moved(kRunwayDeg, ahead, right); };
    // Doors look at the runway, which lies to the south-west of the apron.
    for (int i = 0; i < 6; ++i) put(WorldModel::hangar, beside(-450 + 60.0 * i, -330), kRunwayDeg + 90);
    put(WorldModel::controlTower, beside(60, -280), kRunwayDeg);
    put(WorldModel::flats, beside(140, -330), kRunwayDeg, 0.7);
    for (int i = 0; i < 5; ++i) put(WorldModel::largeHouse, beside(220 + 35.0 * i, -330), kRunwayDeg + 90);
    for (int i = 0; i < 12; ++i) put(WorldModel::house, beside(-300 + 55.0 * i, -430), kRunwayDeg);
    for (int i = 0; i < 60; ++i)
      put(WorldModel::poplar, beside(-450 + 15.0 * i, -470), 0, 0.7 + 0.3 * chance());
    lightRunway();
  }

  /// Lights along both edges, and across both ends: green towards who lands, in the direction of the shipped
  /// flight, and red at the far end.
  void lightRunway() {
    const auto on = [](double ahead, double right) { return Spot{}.moved(kRunwayDeg, ahead, right); };
    for (double ahead = -kRunwayM / 2; ahead <= kRunwayM / 2; ahead += 60)
      for (const double side : {-1.0, 1.0})
        put(WorldModel::runwayLight, on(ahead, side * kRunwayWideM / 2), 0);
    for (double right = -kRunwayWideM / 2; right <= kRunwayWideM / 2; right += 5) {
      put(WorldModel::thresholdLight, on(kRunwayM / 2 + 5, right), 0);
      put(WorldModel::runwayEndLight, on(-kRunwayM / 2 - 5, right), 0);
    }
  }

  /// Streets 70 m apart with houses on both sides, crossed every 180 m; flats and the church in the middle.
  void buildTown() {
    put(WorldModel::church, town_, streetDeg_, 1.1);
    for (int street = -9; street <= 9; ++street)
      for (double along = -kTownM; along <= kTownM; along += 22)
        for (const double side : {-1.0, 1.0}) {
          const Spot at = town_.moved(streetDeg_, along, 70.0 * street + 17 * side);
          const double out = at.distance(town_) / kTownM, turn = streetDeg_ + (side > 0 ? 180 : 0);
          const bool crossing = std::abs(std::remainder(along, 180)) < 12;
          if (crossing || out < 0.07 || out > 1 || chance() < 0.6 * (out - 0.4)) continue;
          if (!within(at) || slopeAt(at) > 0.2) continue;
          const double kind = chance();
          if (out < 0.35 && kind < 0.35 && std::abs(std::remainder(along, 66)) < 11)
            put(WorldModel::flats, at, turn, 0.8 + 0.2 * chance());
          else if (out > 0.35 || std::abs(std::remainder(along, 66)) >= 22)
            put(kind < 0.35 ? WorldModel::largeHouse : WorldModel::house, at, turn, 0.9 + 0.2 * chance());
          if (chance() < 0.5)
            put(chance() < 0.4   ? WorldModel::bush
                : chance() < 0.5 ? WorldModel::birch
                                 : WorldModel::oak,
                town_.moved(streetDeg_, along + 8 * chance(), 70.0 * street + 33 * side), 360 * chance(),
                0.6 + 0.4 * chance());
        }
  }

  /// A lamp every 44 m on one side of each street of the town.
  void lightStreets() {
    for (int street = -9; street <= 9; ++street)
      for (double along = -kTownM; along <= kTownM; along += 44) {
        const Spot at = town_.moved(streetDeg_, along, 70.0 * street + 5);
        if (at.distance(town_) < kTownM && within(at)) put(WorldModel::streetLight, at, 0);
      }
  }

  /// A straight line over the hills north of the flat, where these begin.
  void buildPylons() {
    const double reach = std::min(4.5 * ground_.flatM, 0.8 * half_ * land_.cellM);
    from_ = {-reach, 0.72 * reach}, to_ = {reach, 0.9 * reach};
    bearing_ = 90 - std::atan2(to_.north - from_.north, to_.east - from_.east) * 180 / std::numbers::pi;
    for (double ahead = 0; ahead <= from_.distance(to_); ahead += kPylonStepM)
      put(WorldModel::pylon, from_.moved(bearing_, ahead, 0), bearing_);
  }

  bool isKeptFree(Spot at) const {
    const double turn = kRunwayDeg * std::numbers::pi / 180;
    const double along = at.east * std::sin(turn) + at.north * std::cos(turn),
                 across = at.east * std::cos(turn) - at.north * std::sin(turn);
    if (std::abs(along) < 3000 && std::abs(across) < 520) return true;
    if (at.distance(town_) < kTownM + 60) return true;
    const double line = bearing_ * std::numbers::pi / 180;
    return std::abs((at.east - from_.east) * std::cos(line) - (at.north - from_.north) * std::sin(line)) < 30;
  }

  /// Woods take the cells that suit them best: slopes and what chance made wood, the nearer the better.
  void plantWoods() {
    struct Stand {
      double worth;
      Spot low;
    };
    const double sizeM = 2 * half_ * land_.cellM, reach = std::min(0.45 * sizeM, 22000.0);
    const auto span = static_cast<int>(reach / land_.cellM);
    std::vector<Stand> stands;
    for (int n = -span; n < span; ++n)
      for (int e = -span; e < span; ++e) {
        const Spot low{e * land_.cellM, n * land_.cellM},
            middle{low.east + land_.cellM / 2, low.north + land_.cellM / 2};
        const double away = middle.distance({}) / reach, slope = slopeAt(middle);
        if (away > 1 || slope < kFarmedSlope || slope > kMostSlopeOfWood || !isDry(middle)) continue;
        const double patches = fractalNoise(middle.east / 900, middle.north / 900, 4, ground_.seed + 91);
        const double worth = patches + 3 * std::min(slope, 0.35) - 0.45 * away;
        stands.push_back({worth, low});
      }
    std::stable_sort(stands.begin(), stands.end(),
                     [](const Stand& a, const Stand& b) { return a.worth > b.worth; });
    const double km2 = sizeM * sizeM / 1e6;
    double left = std::min(kMostTrees, kShareWooded * kTreesPerKm2 * km2);
    for (const Stand& stand : stands) {
      if (left <= 0) break;
      const double height = land_.heights[cellOf(stand.low)];
      const double thick = 1 - std::clamp((height - kThinningM) / (kTreeLineM - kThinningM), 0.0, 1.0);
      const double wanted = kTreesPerKm2 * thick * land_.cellM * land_.cellM / 1e6;
      for (auto i = static_cast<int>(wanted + chance()); i > 0 && left > 0; --i) {
        const Spot at{stand.low.east + land_.cellM * chance(), stand.low.north + land_.cellM * chance()};
        const double kind = chance(), turn = 360 * chance(), scale = 0.75 + 0.4 * chance();
        if (isKeptFree(at)) continue;
        put(treeAt(at, height, kind), at, turn, scale);
        --left;
      }
    }
  }

  /// Broadleaf woods low, conifers high, in stands of their own where they meet.
  WorldModel treeAt(Spot at, double height, double kind) const {
    const double stand = fractalNoise(at.east / 400, at.north / 400, 2, ground_.seed + 92);
    if (kind < 0.06) return WorldModel::bush;
    if ((height - 300) / 400 + stand + 0.4 * (kind - 0.5) > 0)
      return kind < 0.4                    ? WorldModel::fir
             : kind < 0.75 || height > 600 ? WorldModel::spruce
                                           : WorldModel::pine;
    return kind < 0.5 ? WorldModel::oak : kind < 0.85 ? WorldModel::birch : WorldModel::pine;
  }

  const WorldGround& ground_;
  const Landscape& land_;
  double half_;
  std::mt19937 random_;
  std::string folder_, text_;
  Spot town_, from_, to_;
  double streetDeg_ = 0, bearing_ = 0;
};

}  // namespace

Result<Done> writeWorld(const std::filesystem::path& list, const WorldGround& ground) {
  const std::filesystem::path folder = list.parent_path() / list.stem();
  if (const auto done = writeWorldModels(folder); !done) return done;
  const std::string text = Planter(ground).planted(folder.filename().string());
  // The list comes last, and whole: where it is, its models are.
  return writeAtomically(list, text);
}

}  // namespace trimtab::terrain
