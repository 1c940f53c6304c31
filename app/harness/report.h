#pragma once

#include <filesystem>
#include <string>

#include "results.h"

namespace trimtab::harness {

/// Returns the document of the HTML page: that of results.json, and what the page draws from it. `quantities`
/// describes the columns of frames, `numbers` of a unit summarises them, `fronts` has the Pareto fronts, and
/// `pictures` has the images of the worst frames, read from `folder`.
std::string pageJson(const Results& results, const std::filesystem::path& folder);
/// Returns the page, which draws itself in a browser and fetches nothing.
std::string htmlReport(const Results& results, const std::filesystem::path& folder);
/// Writes report.html into `folder` atomically.
Result<Done> writeReport(const Results& results, const std::filesystem::path& folder);

}  // namespace trimtab::harness
