#pragma once

#include <cstdint>
#include <span>

#include "trimtab/terrain/format/ground_pyramid.h"
#include "trimtab/terrain/grid/height_window.h"
#include "trimtab/terrain/grid/post_geometry.h"

namespace trimtab::terrain {

/// Makes a tile of the finest level, with one or more texels per post. `rgba`: colours in rows of `line`
/// texels; where alpha is 0, land cover gives the colour.
GroundTile groundTexels(const HeightSource& heights, const PostGeometry& geometry, double texelsPerPost,
                        std::uint32_t tileColumn, std::uint32_t tileRow, GroundTileSize size,
                        std::span<const std::uint8_t> rgba, std::size_t line);

}  // namespace trimtab::terrain
