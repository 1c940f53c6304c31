#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "trimtab/terrain/grid/post_grid.h"
#include "trimtab/terrain/grid/progress.h"

namespace trimtab::terrain {

struct Imported {
  HeightGrid grid;  ///< no voids left
  std::uint64_t voidsFilled = 0;
};

/// Lists files as they are given, and for a folder the rasters inside it without images, sorted.
Result<std::vector<std::filesystem::path>> elevationFiles(std::span<const std::filesystem::path> sources);

/// Reads all of openElevation's grid into memory and fills its voids. Findings include notes about what was
/// assumed, and GDAL's messages.
Result<Imported> importElevation(std::span<const std::filesystem::path> sources, const Progress& progress);

/// Reads one file into memory; voids are NaN.
Result<HeightGrid> readElevation(const std::filesystem::path& file, const Progress& progress);

}  // namespace trimtab::terrain
