#pragma once

#include <memory>

#include "trimtab/terrain/format/store.h"

namespace trimtab::terrain {

/// A database over contents that are complete; fills what of its info follows from the grid.
std::shared_ptr<const Database> makeDatabase(Contents contents);

}  // namespace trimtab::terrain
