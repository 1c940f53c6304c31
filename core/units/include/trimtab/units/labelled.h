#pragma once

#include <string>
#include <string_view>

#include "trimtab/units/result.h"

namespace trimtab {

/// Returns "error", "warning" or "note".
std::string_view label(Severity severity);

/// Returns findings as programs print them on a terminal: "error: where: key: expected ..., found ...", one
/// per line.
std::string labelled(const Findings& findings);

}  // namespace trimtab
