#pragma once

#include <memory>

#include "trimtab/terrain/format/store.h"

namespace trimtab::terrain {

/// Makes a database of complete contents; fills in the part of its info that follows from the grid.
std::shared_ptr<const Database> makeDatabase(Contents contents, std::filesystem::path folder);

}  // namespace trimtab::terrain
