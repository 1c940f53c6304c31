#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>

#include "trimtab/terrain/format/database.h"
#include "trimtab/terrain/grid/progress.h"
#include "trimtab/terrain/objects/source_model.h"

namespace trimtab::terrain {

/// Returns the folder for databases that openOrBake bakes: $XDG_CACHE_HOME/trimtab/terrain, else
/// ~/.cache/trimtab/terrain, else trimtab/terrain in the folder for temporary files.
std::filesystem::path cacheFolder();

/// What stands on the ground, as in BakeOptions.
struct ObjectsToBake {
  std::filesystem::path list;  ///< empty: only what a source itself holds, as a CDB or scenery does
  std::function<Result<SourceModel>(const std::filesystem::path&)> readModel;
};

/// Opens `source` if it is a database. Otherwise bakes it into `cacheFolder` and opens the result, or opens
/// what an earlier call baked there. The cache key covers path, size and time of every source file and of
/// every file that GDAL reads with it, every file of a CDB, every file in the folders of models that scenery
/// places and of what its model lists (`.xml`) may name, and `trianglesPerNode` if the source is scenery.
/// With a list of `objects` it covers the bytes of the list, and size and time of every file in the folders
/// of its models.
Result<std::shared_ptr<const Database>> openOrBake(const std::filesystem::path& source,
                                                   const std::filesystem::path& cacheFolder,
                                                   const Progress& progress,
                                                   std::uint32_t trianglesPerNode = 2000,
                                                   const std::optional<ObjectsToBake>& objects = {});

}  // namespace trimtab::terrain
