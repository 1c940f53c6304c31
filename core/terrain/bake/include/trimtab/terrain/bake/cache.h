#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "trimtab/terrain/format/database.h"
#include "trimtab/terrain/grid/progress.h"

namespace trimtab::terrain {

/// Returns the folder for databases that openOrBake bakes: $XDG_CACHE_HOME/trimtab/terrain, else
/// ~/.cache/trimtab/terrain, else trimtab/terrain in the folder for temporary files.
std::filesystem::path cacheFolder();

/// Opens `source` if it is a database. Otherwise bakes it into `cacheFolder` and opens the result, or opens
/// what an earlier call baked there. The cache key covers path, size and time of every source file and of
/// every file that GDAL reads with it, and `trianglesPerNode` if the source is scenery.
Result<std::shared_ptr<const Database>> openOrBake(const std::filesystem::path& source,
                                                   const std::filesystem::path& cacheFolder,
                                                   const Progress& progress,
                                                   std::uint32_t trianglesPerNode = 2000);

}  // namespace trimtab::terrain
