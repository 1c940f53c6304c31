#pragma once

#include "tests/bench/row.h"

namespace trimtab::bench {

/// Meshes of height fields beside meshoptimizer's of as many triangles, and hmm's.
void mesherRows(Report& report);

}  // namespace trimtab::bench
