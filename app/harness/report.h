#pragma once

#include <filesystem>
#include <string>

#include "results.h"

namespace trimtab::harness {

/// Returns an SVG of frame time against error. It shows two errors for up to two flights, FLIP alone for
/// more.
std::string paretoPlot(const Results& results);

/// Writes report.html and pareto.svg into `folder`, each atomically.
Result<Done> writeReport(const Results& results, const std::filesystem::path& folder);

}  // namespace trimtab::harness
