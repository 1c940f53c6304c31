#pragma once

#include <cstdint>
#include <span>

#include "trimtab/terrain/format/ground_pyramid.h"
#include "trimtab/terrain/grid/height_window.h"
#include "trimtab/terrain/grid/post_geometry.h"

namespace trimtab::terrain {

/// A tile of the finest level, one or more texels a post. `rgba`: colours of its texels where alpha is not
/// 0, rows of `line` texels; elsewhere land cover gives them.
GroundTile groundTexels(const HeightSource& heights, const PostGeometry& geometry, double texelsPerPost,
                        std::uint32_t tileColumn, std::uint32_t tileRow, GroundTileSize size,
                        std::span<const std::uint8_t> rgba, std::size_t line);

}  // namespace trimtab::terrain
