#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>

#include "trimtab/units/result.h"

namespace trimtab::terrain {

/// A file in memory, read-only and shared by all who map it; the disk is read where it is touched. Whoever
/// shortens a mapped file ends its readers: files of a database are replaced as a whole, never changed.
class MappedFile {
 public:
  static Result<std::shared_ptr<const MappedFile>> open(const std::filesystem::path& file);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  const std::filesystem::path& file() const { return file_; }
  std::span<const std::byte> bytes() const { return bytes_; }
  /// Asks the system to begin reading these bytes.
  void fetch(std::size_t at, std::size_t size) const;
  /// These bytes need not be in memory any longer; they are read again where they are touched again.
  void forget(std::size_t at, std::size_t size) const;

 private:
  explicit MappedFile(std::filesystem::path file) : file_(std::move(file)) {}
  std::filesystem::path file_;
  std::span<const std::byte> bytes_;
};

}  // namespace trimtab::terrain
