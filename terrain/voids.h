#pragma once

#include "trimtab/terrain/post_grid.h"

namespace trimtab::terrain {

/// Replaces NaN by a smooth surface through the heights around it (a membrane), and counts them. All void:
/// sea, 0 m.
std::uint64_t fillVoids(HeightGrid& grid);

}  // namespace trimtab::terrain
