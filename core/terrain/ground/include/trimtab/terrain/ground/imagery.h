#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "trimtab/terrain/grid/post_grid.h"
#include "trimtab/terrain/grid/progress.h"

namespace trimtab::terrain {

/// RGBA at each post from a georeferenced raster; alpha 0 where it has nothing.
Result<std::vector<std::uint8_t>> readImagery(const std::filesystem::path& file, const PostGrid& posts,
                                              const Progress& progress);

}  // namespace trimtab::terrain
