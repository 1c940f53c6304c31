#pragma once

#include <span>

#include "trimtab/culling/select.h"

namespace trimtab {

/// Computes the rest of a cut from its tiles and `cut.triangles`. `cones` are the index's, or empty.
void gatherCut(std::span<const Box> bounds, std::span<const NormalCone> cones, LevelCut& cut);

}  // namespace trimtab
