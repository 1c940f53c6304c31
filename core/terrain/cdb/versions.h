#pragma once

#include <filesystem>
#include <vector>

#include "trimtab/units/finding_list.h"

namespace trimtab::terrain {

/// Returns the roots of all versions of a CDB, the first of which replaces what later ones hold: in the order
/// of Metadata/Configuration.xml, else `root` and what Metadata/Version.xml names one after the other. `root`
/// is always among them. Names versions that are not there, and ends where they name each other.
std::vector<std::filesystem::path> cdbVersions(const std::filesystem::path& root, FindingList& findings);

}  // namespace trimtab::terrain
