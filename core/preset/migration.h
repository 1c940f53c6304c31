#pragma once

#include <string>
#include <vector>

#include "trimtab/units/result.h"

namespace trimtab {

/// Format version that is written; older ones are migrated when read, newer ones refused.
inline constexpr int kPresetVersion = 2;

/// A parameter as a file has it: key, JSON text of its value, place for findings.
struct RawParameter {
  std::string key, value, where;
};

/// Brings parameters of an older format version to kPresetVersion; a note for each that was changed.
void migrate(int fromVersion, std::vector<RawParameter>& parameters, Findings& notes);

}  // namespace trimtab
