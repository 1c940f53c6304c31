#pragma once

#include <sys/stat.h>

#include <filesystem>
#include <optional>

namespace trimtab::ig {

/// Notices a changed file by its inode, size and time, so that both replacing and rewriting it are seen. A
/// link is followed, so a link that leads elsewhere is a changed file.
class FileWatch {
 public:
  static constexpr double kPeriodS = 0.2;

  explicit FileWatch(std::filesystem::path file) : file_(std::move(file)), seen_(stampOf(file_)) {}
  /// Reports whether the file is another one than at the last call. False while it is missing.
  bool changed();

 private:
  struct Stamp {
    ino_t inode = 0;
    off_t size = 0;
    timespec time{};
  };
  static std::optional<Stamp> stampOf(const std::filesystem::path& file);

  std::filesystem::path file_;
  std::optional<Stamp> seen_;
};

}  // namespace trimtab::ig
