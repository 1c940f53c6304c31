#pragma once

#include <functional>
#include <string>

#include "trimtab/units/result.h"

namespace trimtab::terrain {

/// Told now and then; returning false cancels. `fraction` is 0..1.
using Progress = std::function<bool(double fraction, const std::string& what)>;

/// Of a longer work's progress, from one share of it to another; `progress` must outlive it.
Progress stageOf(const Progress& progress, double from, double to);

/// What a cancelled step yields.
Finding cancelled(const std::string& what);
/// Nothing made of it is kept.
Finding unreadable(const std::string& what);

}  // namespace trimtab::terrain
