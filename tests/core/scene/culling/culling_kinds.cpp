#include "culling_kinds.h"

#include <algorithm>
#include <cmath>

#include "trimtab/scene/data_extent.h"
#include "trimtab/terrain/format/database.h"

namespace trimtab::test {
namespace {

struct Surroundings {
  int places = 0, higher = 0;  ///< with a height; of these, higher than the ground under the eye
  bool sea = false, land = false;
  double lowest = 1e9, highest = -1e9;
};

/// The ground on circles of 1, 2 and 3 km.
Surroundings around(const GeodeticPosition& eye, double groundM, const terrain::Database& database) {
  Surroundings found;
  constexpr double kRadians = 3.14159265358979 / 180, kDegreeM = 111e3;
  const auto see = [&](double height) {
    (height <= 0.5 ? found.sea : found.land) = true;
    found.lowest = std::min(found.lowest, height), found.highest = std::max(found.highest, height);
  };
  see(groundM);
  for (int i = 0; i < 24; ++i) {
    const double away = 1000.0 * (1 + i % 3), turned = 15 * i * kRadians;
    const auto height = database.heightAt(
        eye.latitude + Degrees{away * std::cos(turned) / kDegreeM},
        wrapped180(eye.longitude +
                   Degrees{away * std::sin(turned) / kDegreeM / std::cos(eye.latitude.value() * kRadians)}));
    if (!height) continue;
    ++found.places;
    found.higher += height->value() > groundM;
    see(height->value());
  }
  return found;
}

}  // namespace

void CullingKinds::add(const FrameRequest& r, const terrain::Database& database) {
  const auto count = [this](Kind kind, bool is) { counts_[kind] += is; };
  count(steep, std::abs(r.attitude.pitch.value()) > 45);
  count(rolled, std::abs(r.attitude.roll.value()) > 15);
  count(dateLine, std::abs(r.eye.longitude.value()) > 179);
  count(pole, std::abs(r.eye.latitude.value()) > 89);
  count(inFog, r.decision.weather.fogged);
  const auto ground = database.heightAt(r.eye.latitude, r.eye.longitude);
  count(beyondEdge, !scene::liesOver(database.info(), r.eye));
  if (!ground) return;
  const double above = (r.eye.height - *ground).value();
  count(below, above < 0);
  count(low, above >= 0 && above < 300);
  count(high, above > 3000);
  const Surroundings s = around(r.eye, ground->value(), database);
  count(inValley, above < 3000 && 4 * s.higher >= 3 * s.places && s.highest - s.lowest > 150);
  count(atCoast, s.sea && s.land);
}

void CullingKinds::add(const CullingKinds& other) {
  for (std::size_t i = 0; i < counts_.size(); ++i) counts_[i] += other.counts_[i];
}

std::string CullingKinds::text() const {
  static constexpr std::array<const char*, kinds> kNames{
      "low",         "high",         "in valleys",      "at coasts", "steep", "rolled", "near the date line",
      "near a pole", "below ground", "beyond the edge", "in fog"};
  std::string all;
  for (std::size_t i = 0; i < counts_.size(); ++i)
    all += (i > 0 ? ", " : "") + std::to_string(counts_[i]) + ' ' + kNames[i];
  return all;
}

}  // namespace trimtab::test
