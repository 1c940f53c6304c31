#pragma once

#include "row.h"

namespace trimtab::bench {

/// Whole frames of the culling cases, one after the other on the same view.
void frameRows(Report& report);

}  // namespace trimtab::bench
