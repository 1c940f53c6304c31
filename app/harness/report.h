#pragma once

#include <filesystem>
#include <string>

#include "results.h"

namespace trimtab::harness {

/// Frame time against error as a picture of its own: two errors for one flight or two, FLIP alone for more.
std::string paretoPlot(const Results& results);

/// report.html and pareto.svg, each written atomically.
Result<Done> writeReport(const Results& results, const std::filesystem::path& folder);

}  // namespace trimtab::harness
