#pragma once

#include <cstdint>
#include <vector>

#include "trimtab/terrain/post_grid.h"

namespace trimtab::terrain {

/// Scenery has no tiles for the open sea. Each connected area that no tile reaches (`reached` 0, one a post)
/// and that meets tiles at sea level along at least half of its border becomes sea: 0 m, in the sea's colour.
/// Takes those posts off `outside`, and says how many there were.
std::uint64_t fillOpenSea(HeightGrid& grid, const std::vector<std::uint8_t>& reached);

}  // namespace trimtab::terrain
