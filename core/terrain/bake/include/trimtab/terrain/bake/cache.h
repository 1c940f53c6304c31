#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "trimtab/terrain/format/database.h"
#include "trimtab/terrain/grid/progress.h"

namespace trimtab::terrain {

/// Where terrain that a program was given as elevation is baked to: $XDG_CACHE_HOME/trimtab/terrain,
/// else ~/.cache/trimtab/terrain, else the same in the folder for temporary files.
std::filesystem::path cacheFolder();

/// Opens a database folder as it is; bakes anything else into the cache folder first (and finds it there next
/// time: keyed by paths, sizes and times of the sources and of the files that GDAL reads with them, and for
/// scenery by `trianglesPerNode`).
Result<std::shared_ptr<const Database>> openOrBake(const std::filesystem::path& source,
                                                   const std::filesystem::path& cacheFolder,
                                                   const Progress& progress,
                                                   std::uint32_t trianglesPerNode = 2000);

}  // namespace trimtab::terrain
