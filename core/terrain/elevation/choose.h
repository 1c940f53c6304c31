#pragma once

#include <memory>
#include <set>
#include <string>
#include <vector>

#include "file.h"

namespace trimtab::terrain {

/// Removes files that hold something else than elevation, with a finding for each: by what is declared, by
/// what the numbers look like, and by a contradiction to a file at the same place for which more speaks. Only
/// files of `found`, which the user did not name, are removed. Where two of the rest contradict each other by
/// more than their relief, warns with both names. The files have to be turned to one side of the earth.
/// Returns false where `progress` asks to stop.
bool chooseElevation(std::vector<std::unique_ptr<ElevationFile>>& files, const std::set<std::string>& found,
                     const Progress& progress, Findings& findings);

}  // namespace trimtab::terrain
