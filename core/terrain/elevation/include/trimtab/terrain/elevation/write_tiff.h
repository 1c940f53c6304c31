#pragma once

#include <filesystem>
#include <functional>
#include <span>

#include "trimtab/terrain/grid/post_grid.h"
#include "trimtab/units/result.h"

namespace trimtab::terrain {

/// Fills the heights, metres, of `count` rows from row `first` on, counted from the north; false cancels.
using TiffRows = std::function<bool(std::uint32_t first, std::uint32_t count, std::span<float> heights)>;

/// Heights on WGS84 posts as a tiled GeoTIFF, some rows in memory at a time. The file appears when it is
/// whole; cancelled or refused, nothing is left of it.
Result<Done> writeTiff(const std::filesystem::path& tif, const PostGrid& posts, const TiffRows& rows);

}  // namespace trimtab::terrain
