#pragma once

#include <span>
#include <string>
#include <vector>

#include "trimtab/terrain/static_lod/lattice.h"

namespace trimtab::terrain {

/// One a vertex, metres: up to what size of a pixel a line at it can be seen; 0 where there is none.
///
/// A road, railway or stream: its width, twice the area of its connected triangles of one material over the
/// length of their border (twice the length of a long strip), ends, crossings and the tile's border left
/// out. A shoreline: the width so measured of the narrower of the water and the land that it parts, or the
/// detail that the vertex adds to the line (how far the line would move without it and all lesser ones), if
/// that is less: infinite where shorelines meet.
std::vector<float> lineWidths(const LatticeTile& tile, std::span<const std::string> materials);

}  // namespace trimtab::terrain
