#pragma once

#include <string>
#include <string_view>

#include "trimtab/units/result.h"

namespace trimtab {

/// Returns "error", "warning" or "note".
std::string_view label(Severity severity);

/// Returns the findings in their order as the programs of this project print them, each on a line of its own
/// that ends in a line feed: "SEVERITY: WHERE: KEY: expected EXPECTED, found FOUND". Parts that a finding
/// lacks are left out. Returns an empty text if there are no findings.
std::string labelled(const Findings& findings);

}  // namespace trimtab
