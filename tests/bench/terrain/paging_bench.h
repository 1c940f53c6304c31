#pragma once

#include "tests/bench/row.h"

namespace trimtab::bench {

/// Choosing patches, opening a database, and flying over it with nothing in memory.
void pagingRows(Report& report);

}  // namespace trimtab::bench
