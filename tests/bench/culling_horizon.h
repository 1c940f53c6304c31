#pragma once

#include "row.h"

namespace trimtab::bench {

/// The horizon over rough ground: what it costs, and how much of what is truly hidden it proves.
void horizonRows(Report& report);

}  // namespace trimtab::bench
