#pragma once

#include <filesystem>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "run.h"

namespace trimtab::harness {

/// What the files of a run's folder depend on: names with values, so that differences can be named.
using PlanLines = std::vector<std::pair<std::string, std::string>>;

/// Names with digests of all values, for a line of a plan; "none" if there are none.
std::string planText(const std::vector<Plan::NamedFlight>& flights);
std::string planText(const std::vector<Plan::NamedPreset>& presets);

/// Makes a run's folder with its plan, or opens one of the same plan. Fails if the folder holds another plan,
/// saying what differs, or no plan but one of `results`, names that the run would write.
Result<Done> openRunFolder(const std::filesystem::path& folder, const char* planFile, const PlanLines& plan,
                           std::initializer_list<const char*> results);

}  // namespace trimtab::harness
