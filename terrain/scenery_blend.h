#pragma once

#include <cstdint>
#include <vector>

#include "trimtab/terrain/post_grid.h"

namespace trimtab::terrain {

/// Gives `grid` the heights of `elevation` (NaN: none) at posts that are void, bilinear between its posts,
/// and marks those as `reached`. Around what was there the difference to it is spread over 32 posts (a
/// membrane), so that there is no step.
void blendElevation(HeightGrid& grid, const HeightGrid& elevation, std::vector<std::uint8_t>& reached);

/// Bilinear, degrees; of what corners there are where some are void; NaN where all are or it lies outside.
double heightOf(const HeightGrid& grid, double longitude, double latitude);

}  // namespace trimtab::terrain
