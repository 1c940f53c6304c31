#pragma once

#include <string>
#include <string_view>

#include "trimtab/units/result.h"

namespace trimtab {

/// "error", "warning" or "note".
std::string_view label(Severity severity);

/// Findings as programs print them on a terminal: "error: where: key: expected ..., found ...", each on a
/// line of its own.
std::string labelled(const Findings& findings);

}  // namespace trimtab
