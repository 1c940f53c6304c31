#include "trimtab/frame/ground_heights.h"

namespace trimtab {

std::optional<GroundSlope> slopeAt(const GroundHeights& ground, Degrees latitude, Degrees longitude) {
  const LocalFrame frame({latitude, longitude, Metres{0}});
  const double half = ground.postDistance().value() / 2;
  const auto at = [&](double east, double north) {
    const GeodeticPosition place = frame.toGeodetic({east, north, 0});
    return ground.heightAt(place.latitude, place.longitude);
  };
  const auto west = at(-half, 0), east = at(half, 0), south = at(0, -half), north = at(0, half);
  if (!west || !east || !south || !north) return std::nullopt;
  return GroundSlope{(*east - *west).value() / (2 * half), (*north - *south).value() / (2 * half)};
}

}  // namespace trimtab
