#pragma once

#include <string>
#include <vector>

#include "trimtab/preset/parameters.h"
#include "trimtab/units/result.h"

namespace trimtab {

/// Format version that is written; older ones are migrated when read, newer ones refused.
inline constexpr int kPresetVersion = 3;

/// A parameter as a file has it: key, JSON text of its value, place for findings.
struct RawParameter {
  std::string key, value, where;
};

/// Brings parameters of an older format version to kPresetVersion; a note for each that was changed, an error
/// for a value that cannot be taken over. `base` is what the file differs from.
void migrate(int fromVersion, const TuningParameters& base, std::vector<RawParameter>& parameters,
             Findings& notes);

}  // namespace trimtab
