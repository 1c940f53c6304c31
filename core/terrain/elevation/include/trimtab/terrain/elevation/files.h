#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "trimtab/units/result.h"

namespace trimtab::terrain {

/// Lists files as they are given, and for a folder the rasters inside it without images, sorted.
Result<std::vector<std::filesystem::path>> elevationFiles(std::span<const std::filesystem::path> sources);

}  // namespace trimtab::terrain
