#pragma once

#include <cstdint>
#include <string_view>

namespace trimtab::terrain {

/// Line features, which scenery draws as long thin triangles.
enum class LineFeature : std::uint8_t { none, road, railway, stream };
/// Returns which line feature a material is. Airports use the same materials, so do not ask for their
/// triangles.
LineFeature lineFeatureOf(std::string_view material);
/// Reports whether a material is open water: sea, lakes, broad rivers. Its borders with other materials are
/// shorelines.
bool isWater(std::string_view material);
/// Reports whether a tile of this name is an airport ("EDNY"). Names of other tiles are all digits.
bool isAirport(std::string_view tile);

}  // namespace trimtab::terrain
