#pragma once

#include <filesystem>
#include <span>

#include "trimtab/terrain/database.h"
#include "trimtab/terrain/post_grid.h"

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

/// RGBA at each post from a georeferenced raster; alpha 0 where it has nothing.
Result<std::vector<std::uint8_t>> readImagery(const std::filesystem::path& file, const PostGrid& posts,
                                              const Progress& progress);

/// Of a longer work's progress, from one share of it to another; `progress` must outlive it.
Progress stageOf(const Progress& progress, double from, double to);

/// What a cancelled step yields.
Finding cancelled(const std::string& what);
/// Nothing made of it is kept.
Finding unreadable(const std::string& what);

}  // namespace trimtab::terrain
