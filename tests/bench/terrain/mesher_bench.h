#pragma once

#include "tests/bench/row.h"

namespace trimtab::bench {

/// Measures meshes of height fields, made to hmm's largest error, beside hmm's and beside meshoptimizer's
/// with as many triangles.
void mesherRows(Report& report);

}  // namespace trimtab::bench
