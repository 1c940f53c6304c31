#pragma once

#include <functional>
#include <string>

#include "trimtab/units/result.h"

namespace trimtab::terrain {

/// Called now and then with the fraction done, 0 to 1; returning false cancels.
using Progress = std::function<bool(double fraction, const std::string& what)>;

/// Returns the progress of one stage, which covers the fractions `from` to `to` of the whole. `progress` must
/// outlive it.
Progress stageOf(const Progress& progress, double from, double to);

/// Returns the finding of a cancelled step.
Finding cancelled(const std::string& what);
/// Returns the finding for a source that could not be read; what was made from it is discarded.
Finding unreadable(const std::string& what);

}  // namespace trimtab::terrain
