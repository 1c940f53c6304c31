#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "trimtab/terrain/grid/post_grid.h"
#include "trimtab/terrain/grid/progress.h"

namespace trimtab::terrain {

/// Reads a georeferenced image at each post: RGBA, rows from south; alpha is 0 where it has no colour.
Result<std::vector<std::uint8_t>> readImagery(const std::filesystem::path& file, const PostGrid& posts,
                                              const Progress& progress);

}  // namespace trimtab::terrain
