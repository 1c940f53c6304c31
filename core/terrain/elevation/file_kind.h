#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "trimtab/terrain/elevation/gdal_errors.h"

/// Says what a file is that GDAL cannot open as a raster.
namespace trimtab::terrain {

/// Tells whether a file's name says that it is a raster.
bool isRasterName(const std::filesystem::path& file);

/// Says in a person's words what a file is, and what to do about it. `errors`: what GDAL said when it failed.
std::string whatItIs(const std::filesystem::path& file, const GdalErrors& errors);

/// Does the same in a few words, for a list of files that nobody takes for rasters.
std::string kindOf(const std::filesystem::path& file);

}  // namespace trimtab::terrain
