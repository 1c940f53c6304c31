#pragma once

#include <array>
#include <cstdint>

namespace trimtab::terrain {

/// sRGB of ground that no image covers, by height, slope (rise over run) and latitude: water where it is flat
/// at or below the sea, fields, forest, rock where it is steep, snow above a line that falls towards the
/// poles. `row` and `column` give each post its own shade.
std::array<std::uint8_t, 3> landCover(double heightM, double slope, double latitudeDeg, std::uint32_t row,
                                      std::uint32_t column);

}  // namespace trimtab::terrain
