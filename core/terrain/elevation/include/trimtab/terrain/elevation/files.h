#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "trimtab/units/result.h"

namespace trimtab::terrain {

/// A file to read elevation from; `FILE:NAME` is a raster of a file that holds several.
struct ElevationPath {
  std::filesystem::path file;
  bool named = true;   ///< by the user; false: found in a folder, where a file that cannot be used is left out
  bool weighed = true;  ///< it may be no elevation; false: its folder says that it is
};

/// Lists files as they are given, and for a folder the rasters inside it, sorted. What else a folder has is
/// named with the reason: broken files as warnings, images and files that are no rasters as notes. Of a CDB
/// they are its tiles of elevation that show somewhere, finest first (trimtab/terrain/cdb). Fails if a
/// source is not there, or a folder has no raster of heights.
Result<std::vector<ElevationPath>> elevationPaths(std::span<const std::filesystem::path> sources);
/// Returns the paths alone.
Result<std::vector<std::filesystem::path>> elevationFiles(std::span<const std::filesystem::path> sources);

/// Returns the file of a `FILE:NAME`, or the path itself if it names no raster of a container.
std::filesystem::path containerOf(const std::filesystem::path& path);

}  // namespace trimtab::terrain
