#include "trimtab/frame/weather_decision.h"

#include <cmath>

namespace trimtab {

Vec3 eastNorthUp(const Wind& wind) {
  const double from = wind.from.in<Radians>(), speed = wind.speed.value();
  return {-speed * std::sin(from), -speed * std::cos(from), wind.up.value()};
}

}  // namespace trimtab
