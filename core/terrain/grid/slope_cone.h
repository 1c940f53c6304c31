#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace trimtab::terrain {

/// The narrowest cone that contains the upward normals of all added surfaces, with its axis at the middle of
/// their slopes' bounds. Slopes are rise over run.
class SlopeCone {
 public:
  SlopeCone() { slopes_.reserve(2200); }  // all triangles of a tile
  void add(double east, double north) {
    slopes_.push_back({east, north});
    low_ = {std::min(low_[0], east), std::min(low_[1], north)};
    high_ = {std::max(high_[0], east), std::max(high_[1], north)};
  }
  /// Adds both triangles of a cell. `h` holds its heights: south-west, south-east, north-west, north-east.
  /// Heights: south-west, south-east, north-west, north-east.
  void addCell(const std::array<double, 4>& h, double southM, double northM, double highM,
               bool southWestNorthEast) {
    const double south = (h[1] - h[0]) / southM, north = (h[3] - h[2]) / northM, west = (h[2] - h[0]) / highM,
                 east = (h[3] - h[1]) / highM;
    add(south, southWestNorthEast ? east : west);
    add(north, southWestNorthEast ? west : east);
  }
  std::pair<double, double> middle() const { return {(low_[0] + high_[0]) / 2, (low_[1] + high_[1]) / 2}; }
  /// Returns the cone's half angle, radians; 2, more than a right angle, if nothing was added.
  double halfAngle() const {
    if (slopes_.empty()) return 2;
    const auto [x, y] = middle();
    double least = 1;
    for (const auto& [east, north] : slopes_) {
      const double along = 1 + x * east + y * north;
      least = std::min(least, along * std::abs(along) / (1 + east * east + north * north));
    }
    return std::acos(
        std::clamp(std::copysign(std::sqrt(std::abs(least) / (1 + x * x + y * y)), least), -1.0, 1.0));
  }

 private:
  static constexpr double kFar = 1e30;
  std::vector<std::array<double, 2>> slopes_;
  std::array<double, 2> low_{kFar, kFar}, high_{-kFar, -kFar};
};

}  // namespace trimtab::terrain
