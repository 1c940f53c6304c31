#pragma once

#include <memory>
#include <string>

#include "trimtab/terrain/format/database.h"
#include "trimtab/terrain/grid/progress.h"

namespace trimtab::cli {

/// Opens a database or a scene of OpenSceneGraph, or bakes anything else first. `origin` is the option
/// --origin. Prints all findings on standard error, and returns null on an error.
std::shared_ptr<const terrain::Database> openTerrain(const std::string& terrain, const std::string& origin,
                                                     const terrain::Progress& progress);

}  // namespace trimtab::cli
