#pragma once

#include <sys/stat.h>

#include <optional>
#include <string>

#include "trimtab/preset/preset.h"

namespace trimtab::ig {

/// A preset that loaded and passed every rule.
struct ActivePreset {
  std::string name;
  ValidatedParameters parameters;
};
/// Loads and checks a preset. Findings are its errors, or the warnings about a valid preset.
Result<ActivePreset> loadActivePreset(const std::string& nameOrFile);

/// Notices a changed file by its inode, size and time, so that both replacing and rewriting it are seen.
class PresetWatch {
 public:
  static constexpr double kPeriodS = 0.2;

  explicit PresetWatch(std::string file);
  /// Returns the preset of the changed file, or why it is refused. Returns nothing if nothing changed or the
  /// file is missing at the moment.
  std::optional<Result<ActivePreset>> poll();

 private:
  struct Stamp {
    ino_t inode = 0;
    off_t size = 0;
    timespec time{};
  };
  static std::optional<Stamp> stampOf(const std::string& file);

  std::string file_;
  std::optional<Stamp> seen_;
};

}  // namespace trimtab::ig
