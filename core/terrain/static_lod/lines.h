#pragma once

#include <span>
#include <string>
#include <vector>

#include "trimtab/terrain/static_lod/lattice.h"

namespace trimtab::terrain {

/// Returns per vertex the size of a pixel, metres, up to which a line at it can be seen; 0 without a line.
///
/// For a road, railway or stream this is its width: twice the area of its connected triangles of one
/// material over the length of their border (twice the length of a long strip), without ends, crossings and
/// the tile's border. For a shoreline it is the lesser of two numbers: the width, measured likewise, of the
/// narrower of the water and the land that it parts, and the detail that the vertex adds to the line, which
/// is how far the line would move without it and all lesser ones, and infinite where shorelines meet.
std::vector<float> lineWidths(const LatticeTile& tile, std::span<const std::string> materials);

}  // namespace trimtab::terrain
