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

/// Files as they are given, folders as the rasters inside them (images left out), sorted.
Result<std::vector<std::filesystem::path>> elevationFiles(std::span<const std::filesystem::path> sources);

/// What openElevation reads, in memory, with voids filled. Findings carry notes about what was assumed, and
/// GDAL's own words.
Result<Imported> importElevation(std::span<const std::filesystem::path> sources, const Progress& progress);

/// One file, with its voids as NaN.
Result<HeightGrid> readElevation(const std::filesystem::path& file, const Progress& progress);

}  // namespace trimtab::terrain
