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
/// Findings tell what is wrong, or what is odd about a preset that is right.
Result<ActivePreset> loadActivePreset(const std::string& nameOrFile);

/// Tells when a file is another one than before: by inode, size and time, so that both a rename over it and a
/// rewrite in place are seen.
class PresetWatch {
 public:
  static constexpr double kPeriodS = 0.2;

  explicit PresetWatch(std::string file);
  /// The changed file's preset, or why it is refused; none when nothing changed, or it is not there at the
  /// moment.
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
