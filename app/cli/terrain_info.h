#pragma once

#include <filesystem>

#include "trimtab/terrain/format/database.h"

namespace trimtab::cli {

/// What a terrain database holds, on standard output: lines, or one JSON document.
void printInfo(const terrain::Database& database, bool json);

/// The same of scenery that is not baked: a tile, a list or a folder. Findings on standard error; the exit
/// code.
int printSceneryInfo(const std::filesystem::path& path, bool json);

}  // namespace trimtab::cli
