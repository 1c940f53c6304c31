#pragma once

#include <algorithm>
#include <cmath>

/// The earth as a sphere, where that is exact enough: for the horizon and for haze.
namespace trimtab {

/// The mean radius of the earth, metres.
inline constexpr double kEarthRadiusM = 6371e3;

/// Returns how far below the level the horizon of a smooth earth lies, radians; 0 at or below sea level.
inline double horizonDip(double heightM) {
  return std::acos(std::min(1.0, kEarthRadiusM / (kEarthRadiusM + heightM)));
}

}  // namespace trimtab
