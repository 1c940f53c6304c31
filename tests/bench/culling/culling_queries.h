#pragma once

#include <memory>
#include <string>

#include "tests/bench/row.h"
#include "trimtab/terrain/format/database.h"

namespace trimtab::bench {

/// Frames of *proposed*, by horizon and by depth map, beside those that ask the hardware tile by tile.
void queryRows(Report& report, const std::string& name,
               const std::shared_ptr<const terrain::Database>& database);

}  // namespace trimtab::bench
