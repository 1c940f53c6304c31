#pragma once

#include <cstdint>
#include <span>

#include "trimtab/culling/select.h"

namespace trimtab {

/// What selectVisible does, whatever the nodes are. Vertices are the caller's to count.
void walkCut(const LevelCut& cut, const EyePose& eye, const ViewShape& view, bool test, double farM,
             std::span<const std::uint8_t> hidden, bool backFaces, VisibleSet& visible);

/// Makes the rest of a cut from its tiles and `cut.triangles`. `cones`: the index's, or empty.
void gatherCut(std::span<const Box> bounds, std::span<const NormalCone> cones, LevelCut& cut);

}  // namespace trimtab
