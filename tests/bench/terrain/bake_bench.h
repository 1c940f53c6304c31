#pragma once

#include "tests/bench/row.h"

namespace trimtab::bench {

/// Databases baked: a real cell beside what osgdem takes for it, and a country at three sizes. Each bake runs
/// in a process of its own, whose peak of memory is its own.
void bakingRows(Report& report);

}  // namespace trimtab::bench
