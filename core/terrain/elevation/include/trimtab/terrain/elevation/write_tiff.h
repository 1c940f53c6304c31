#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>

#include "trimtab/terrain/grid/post_grid.h"
#include "trimtab/units/result.h"

namespace trimtab::terrain {

/// Fills in the heights, metres, of `count` rows from row `first` on, counted from the north. Returning false
/// cancels.
using TiffRows = std::function<bool(std::uint32_t first, std::uint32_t count, std::span<float> heights)>;

/// Writes heights on WGS84 posts as a tiled GeoTIFF, a few rows at a time. The file appears under its name
/// when it is complete; if writing fails or is cancelled, no file is left.
Result<Done> writeTiff(const std::filesystem::path& tif, const PostGrid& posts, const TiffRows& rows);

/// Does what TiffRows does, for red, green and blue of each pixel.
using TiffPixels = std::function<bool(std::uint32_t first, std::uint32_t count, std::span<std::uint8_t> rgb)>;
/// Writes an image whose pixels' centres are the posts, as a tiled GeoTIFF with JPEG compression, in the same
/// way.
Result<Done> writePicture(const std::filesystem::path& tif, const PostGrid& pixels, const TiffPixels& rows);

}  // namespace trimtab::terrain
