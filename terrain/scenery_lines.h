#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "trimtab/terrain/scenery.h"

namespace trimtab::terrain {

/// What scenery draws as long thin triangles, by its material.
enum class LineFeature : std::uint8_t { none, road, railway, stream };
LineFeature lineFeatureOf(std::string_view material);
/// Areas of open water: sea, lakes, broad rivers. Their borders with anything else are shorelines.
bool isWater(std::string_view material);

/// A triangle to paint the ground with.
struct GroundTriangle {
  std::array<double, 3> longitude{}, latitude{};  ///< degrees
  std::array<std::uint8_t, 3> colour{};           ///< sRGB
  LineFeature line = LineFeature::none;
  bool water = false;
};
/// All triangles of some scenery, those that belong on top last: areas, lines, airports, paint on pavement.
/// Longitudes lie within 180 degrees of `nearLongitude`.
std::vector<GroundTriangle> groundTriangles(std::span<const SceneryMesh> meshes, double nearLongitude);

}  // namespace trimtab::terrain
