#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "trimtab/terrain/grid/post_grid.h"
#include "trimtab/terrain/grid/progress.h"

namespace trimtab::terrain {

/// Lists the files of imagery: the file itself, or of a folder every raster inside, sorted; of a CDB its tiles
/// of imagery that show somewhere, finest first. Refuses a path where nothing is, and a folder without
/// rasters.
Result<std::vector<std::filesystem::path>> imageryFiles(const std::filesystem::path& imagery);

/// Lists those of imageryFiles that may cover some of the posts. Of a folder, files that cannot be drawn are
/// left out with a warning that says why, and the number of those that lie elsewhere is a note; it is an
/// error if none is left. A single file is returned as it is.
Result<std::vector<std::filesystem::path>> imageryOver(const std::filesystem::path& imagery,
                                                       const PostGrid& posts);

/// Reads georeferenced images at each post: RGBA, rows from south; alpha is 0 where none has a colour. Where
/// several have one, the first counts.
Result<std::vector<std::uint8_t>> readImagery(std::span<const std::filesystem::path> files,
                                              const PostGrid& posts, const Progress& progress);

/// Puts an image over colours of the same posts, both RGBA: these stay where it has none. An empty `under`
/// becomes the image.
void drape(std::vector<std::uint8_t> image, std::vector<std::uint8_t>& under);

}  // namespace trimtab::terrain
