#pragma once

#include <algorithm>

namespace trimtab::terrain {

/// An area in degrees. Longitudes do not wrap.
struct Rectangle {
  double west = 0, south = 0, east = 0, north = 0;

  /// Returns an empty rectangle, to which places can be added.
  static constexpr Rectangle none() { return {1e9, 1e9, -1e9, -1e9}; }
  bool empty() const { return west > east; }
  void add(double longitude, double latitude) {
    west = std::min(west, longitude);
    east = std::max(east, longitude);
    south = std::min(south, latitude);
    north = std::max(north, latitude);
  }
  void add(const Rectangle& other) {
    if (other.empty()) return;
    add(other.west, other.south);
    add(other.east, other.north);
  }
  Rectangle turned(double degrees) const { return {west + degrees, south, east + degrees, north}; }
  bool meets(const Rectangle& other) const {
    return west <= other.east && other.west <= east && south <= other.north && other.south <= north;
  }
};

}  // namespace trimtab::terrain
