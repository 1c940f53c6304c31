#pragma once

#include <string>
#include <string_view>

#include "report.h"
#include "trimtab/units/result.h"

namespace trimtab::experiment {

/// Reads what toJson(const Report&) wrote, for whoever lets another program measure. What was no number is
/// none again. Fails on anything else.
Result<Report> parseReport(std::string_view json, const std::string& where);

}  // namespace trimtab::experiment
