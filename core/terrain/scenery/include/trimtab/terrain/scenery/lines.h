#pragma once

#include <cstdint>
#include <string_view>

namespace trimtab::terrain {

/// What scenery draws as long thin triangles, by its material.
enum class LineFeature : std::uint8_t { none, road, railway, stream };
LineFeature lineFeatureOf(std::string_view material);
/// Areas of open water: sea, lakes, broad rivers. Their borders with anything else are shorelines.
bool isWater(std::string_view material);
/// Returns whether a tile of this name is an airport ("EDNY"). Names of other tiles are all digits.
bool isAirport(std::string_view tile);

}  // namespace trimtab::terrain
