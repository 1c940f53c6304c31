#pragma once

#include "tests/bench/row.h"

namespace trimtab::bench {

/// The CPU's depth map over rough ground: what it costs, and how much of what is truly hidden it proves.
void depthMapRows(Report& report);

}  // namespace trimtab::bench
