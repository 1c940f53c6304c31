#pragma once

#include <string>
#include <vector>

#include "trimtab/preset/parameters.h"
#include "trimtab/units/finding_list.h"

namespace trimtab {

/// Format version that is written; older ones are migrated when read, newer ones refused.
inline constexpr int kPresetVersion = 3;

/// A parameter as a file has it: key, JSON text of its value, place for findings.
struct RawParameter {
  std::string key, value, where;
};

/// Brings the parameters of a file of version `fromVersion` to kPresetVersion, and replaces values that were
/// withdrawn. Adds a note for each parameter that it changes, and an error for each value that it cannot
/// convert. `base` holds the values of every parameter that the file leaves out.
void migrate(int fromVersion, const TuningParameters& base, std::vector<RawParameter>& parameters,
             FindingList& notes);

/// Adds to the parameters of an export those that are younger than it and whose default would draw another
/// image than the program that wrote it, with a note for each. A preset says only what differs from its base
/// and follows the program; an export is what an image generator was accepted with. `where` is its file.
void keepFormerBehaviour(std::vector<RawParameter>& parameters, const std::string& where, FindingList& notes);

}  // namespace trimtab
