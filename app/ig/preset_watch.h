#pragma once

#include <optional>
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

/// Loads a preset again whenever its file changes.
class PresetWatch {
 public:
  explicit PresetWatch(std::string file) : file_(std::move(file)), watch_(file_) {}
  /// Returns the preset of the changed file, or why it is refused. Returns nothing if nothing changed or the
  /// file is missing at the moment.
  std::optional<Result<ActivePreset>> poll();

 private:
  std::string file_;
  FileWatch watch_;
};

}  // namespace trimtab::ig
