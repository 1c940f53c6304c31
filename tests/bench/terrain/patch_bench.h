#pragma once

#include "tests/bench/row.h"

namespace trimtab::bench {

/// Error-bounded levels: their triangles beside an unconstrained mesh's, how long they take, how large they
/// are.
void patchRows(Report& report);

}  // namespace trimtab::bench
