#pragma once

#include <string>

#include "file_watch.h"
#include "trimtab/preset/preset.h"

namespace trimtab::ig {

/// A preset that loaded and passed every rule.
struct ActivePreset {
  std::string name;
  ValidatedParameters parameters;
};
/// Loads and checks a preset. Findings are its errors, or the warnings about a valid preset.
Result<ActivePreset> loadActivePreset(const std::string& nameOrFile);

using PresetWatch = Watch<ActivePreset>;

}  // namespace trimtab::ig
