#pragma once

#include "tests/bench/row.h"

namespace trimtab::bench {

/// The horizon over rough ground: what it costs, and how much of what is truly hidden it proves.
void horizonRows(Report& report);
/// The same of an eye that flies: what a frame costs, on average and at most.
void movingHorizonRows(Report& report);

}  // namespace trimtab::bench
