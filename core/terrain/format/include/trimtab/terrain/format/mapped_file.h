#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>

#include "trimtab/units/result.h"

namespace trimtab::terrain {

/// A read-only memory map of a file; the system reads the disk when bytes are first accessed. If a file is
/// truncated while it is mapped, its readers are killed by SIGBUS: replace files of a database, never change
/// them.
class MappedFile {
 public:
  static Result<std::shared_ptr<const MappedFile>> open(const std::filesystem::path& file);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  const std::filesystem::path& file() const { return file_; }
  std::span<const std::byte> bytes() const { return bytes_; }
  /// Asks the system to start reading these bytes, and returns at once.
  void fetch(std::size_t at, std::size_t size) const;
  /// Lets the system drop these bytes from memory; they are read again when they are accessed.
  void forget(std::size_t at, std::size_t size) const;

 private:
  explicit MappedFile(std::filesystem::path file) : file_(std::move(file)) {}
  std::filesystem::path file_;
  std::span<const std::byte> bytes_;
};

}  // namespace trimtab::terrain
