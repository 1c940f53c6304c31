#pragma once

#include <array>
#include <cstdint>

namespace trimtab::terrain {

/// Returns an sRGB colour for ground that no image covers, by height, slope (rise over run) and latitude:
/// water on flat ground at or below the sea, fields, forest, rock on steep ground, snow above a line that is
/// lower towards the poles. `row` and `column` vary the shade from post to post.
std::array<std::uint8_t, 3> landCover(double heightM, double slope, double latitudeDeg, std::uint32_t row,
                                      std::uint32_t column);

}  // namespace trimtab::terrain
