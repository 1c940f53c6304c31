#pragma once

#include <filesystem>
#include <string>

#include "trimtab/hold/cost_model.h"
#include "trimtab/units/result.h"

/// Keeps what a machine's images cost from one run to the next.
namespace trimtab {

/// Returns the name of this machine as it draws: its processor (if the system names it), how many cores this
/// process may use, and the GL renderer. The renderer alone does not do, because a software rasteriser's
/// names no processor.
std::string machineName(const std::string& glRenderer);

/// Writes a model with the name of the machine that it was learned on. The file is the old one or the whole
/// new one, whatever happens on the way. A model that could not be read again is a finding, and not written.
Result<Done> writeCostModel(const std::filesystem::path& file, const std::string& machine,
                            const CostModel& model);
/// Reads a model. Damage, each number that no model can have (CostModel::State::forEachNumber), and a model
/// of another machine are findings that name line, number, range and what was found; a caller then begins
/// without one.
Result<CostModel::State> readCostModel(const std::filesystem::path& file, const std::string& machine);

/// Returns where programs keep the model of a machine: a file of its own, named after it, in trimtab's folder
/// of the user's caches (XDG_CACHE_HOME, else ~/.cache). It is empty if there is neither.
std::filesystem::path costModelFile(const std::string& machine);

/// Gives the model what costModelFile() knows of this machine. A file that is missing is no finding; one that
/// cannot be used is, and the model stays as it is.
Findings recallCostModel(CostModel& model, const std::string& machine);
/// Writes the model there, unless it has learned from too few images to be worth it. Returns what failed.
Findings rememberCostModel(const CostModel& model, const std::string& machine);

}  // namespace trimtab
