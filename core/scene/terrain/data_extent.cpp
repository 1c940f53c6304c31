#include "trimtab/scene/data_extent.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace trimtab::scene {
namespace {

constexpr double kEarthRadius = 6.37e6;
constexpr double kRadians = std::numbers::pi / 180;

/// Reports whether every straight line from a place to one on a parallel of latitude, at most `away` degrees
/// of longitude off, comes to it from the equator's side. North is where that parallel is.
///
/// Places of one latitude, at any height, make a cone about the earth's axis, and what is nearer the pole is
/// inside of it. A line enters the cone where its eye is on the inner side of the plane that touches the cone
/// there, and nowhere else: so the eye must be on the outer side of all of those planes, of which the one
/// furthest away in longitude is the closest. Meridians are planes, and the border on the equator's side
/// bends outwards: lines between two places inside do not cross those.
bool seesParallelFromOutside(double parallel, double latitude, double height, double away) {
  if (parallel <= 0) return true;
  if (!(away < 90)) return false;
  constexpr double kAxis = 6378137, kSquare = 6.69437999014e-3;  // WGS84
  const auto normalRadius = [](double degrees) {
    const double sine = std::sin(degrees * kRadians);
    return kAxis / std::sqrt(1 - kSquare * sine * sine);
  };
  const double own = normalRadius(latitude), sine = std::sin(parallel * kRadians),
               cosine = std::cos(parallel * kRadians), apex = -kSquare * normalRadius(parallel) * sine,
               out = (own + height) * std::cos(latitude * kRadians),
               up = (own * (1 - kSquare) + height) * std::sin(latitude * kRadians) - apex;
  return out * sine * std::cos(away * kRadians) > up * cosine;
}

}  // namespace

DataExtent::DataExtent(const terrain::TerrainInfo& info)
    : south_(info.southWest.latitude.value()),
      north_(info.northEast.latitude.value()),
      middle_(info.southWest.longitude.value() + widthOf(info).value() / 2),
      width_(widthOf(info).value()),
      metresNorth_(110500) {
  const double furthest = std::max(std::abs(south_), std::abs(north_));
  metresEast_ = 111300 * std::cos(furthest * kRadians);
  // A parallel of latitude bends by d^2 tan(latitude) / 8R over a distance d; a meridian not at all.
  const double across = width_ * 111300;
  sagM_ = furthest < 85 ? 1.1 * across * across * std::tan(furthest * kRadians) / (8 * kEarthRadius) : 1e9;
}

const char* DataExtent::refusal(const LocalFrame& frame, Vec3 eye) const {
  const GeodeticPosition place = frame.toGeodetic(eye);
  const double latitude = place.latitude.value(),
               away = std::abs(wrapped180(place.longitude - Degrees{middle_}).value());
  const double inside = std::min({(latitude - south_) * metresNorth_, (north_ - latitude) * metresNorth_,
                                  (width_ / 2 - away) * metresEast_});
  if (!(inside > 0)) return "The eye is not over the terrain.";
  // The frame's z leans away from the vertical far from its origin: the place under the eye, by z, is
  // elsewhere.
  if (!(inside > sagM_ + std::abs(place.height.value()) * leanOf(eye)))
    return "The eye is too near the terrain's edge.";
  const double furthest = away + width_ / 2;
  if (!seesParallelFromOutside(north_, latitude, place.height.value(), furthest) ||
      !seesParallelFromOutside(-south_, -latitude, place.height.value(), furthest))
    return "The eye is too near the terrain's edge.";
  return "";
}

Degrees widthOf(const terrain::TerrainInfo& info) {
  return info.postLongitude * (info.columns > 1 ? info.columns - 1.0 : 0.0);
}

terrain::PostGrid postsOf(const terrain::TerrainInfo& info) {
  return {info.southWest.longitude.value(),
          info.southWest.latitude.value(),
          info.postLongitude.value(),
          info.postLatitude.value(),
          info.columns,
          info.rows};
}

GeodeticPosition placeIn(const terrain::TerrainInfo& info, double east, double north) {
  return {info.southWest.latitude + (info.northEast.latitude - info.southWest.latitude) * north,
          wrapped180(info.southWest.longitude + widthOf(info) * east), Metres{0}};
}

bool liesOver(const terrain::TerrainInfo& info, const GeodeticPosition& place) {
  double east = std::fmod((place.longitude - info.southWest.longitude).value(), 360);
  if (east < 0) east += 360;
  // Borders are given rounded: a place on the western one may be a little west of it.
  constexpr double kRounding = 1e-9;
  return place.latitude >= info.southWest.latitude && place.latitude <= info.northEast.latitude &&
         (east <= widthOf(info).value() + kRounding || east >= 360 - kRounding);
}

double leanOf(Vec3 place) {
  return std::hypot(place.x, place.y) / kEarthRadius;
}

const char* nearPlaneRefusal(double aboveM, double nearestM, double slope) {
  if (!(aboveM > 0)) return "The eye is under the ground.";
  if (!(aboveM > nearestM * std::sqrt(1 + slope * slope))) return "The eye is too near the ground.";
  return "";
}

double nearestOf(const ViewShape& view) {
  const double across = std::max(std::abs(view.left), std::abs(view.right)),
               upward = std::max(std::abs(view.bottom), std::abs(view.top));
  return view.nearM * std::sqrt(1 + across * across + upward * upward);
}

}  // namespace trimtab::scene
