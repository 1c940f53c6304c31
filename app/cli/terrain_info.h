#pragma once

#include <filesystem>

#include "trimtab/terrain/format/database.h"

namespace trimtab::cli {

/// Prints on standard output what a terrain database holds, as lines or as one JSON document.
void printInfo(const terrain::Database& database, bool json);

/// Prints the same for scenery that is not baked: a tile, a list or a folder. Findings go to standard error.
/// Returns the exit code.
int printSceneryInfo(const std::filesystem::path& path, bool json);

}  // namespace trimtab::cli
