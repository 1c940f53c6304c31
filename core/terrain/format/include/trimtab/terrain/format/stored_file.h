#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include "trimtab/units/result.h"

/// Reads the files of a database. Bytes are copied, never mapped, for two reasons: a file that is cut short
/// while it is open gives a finding, where a mapping would kill its readers by SIGBUS; and what was checked
/// is what is used, where a mapped file may change between the check and the use.
namespace trimtab::terrain {

/// A regular file that is open for reading. Safe on any thread.
class StoredFile {
 public:
  static Result<std::shared_ptr<const StoredFile>> open(const std::filesystem::path& file);
  ~StoredFile();
  StoredFile(const StoredFile&) = delete;
  StoredFile& operator=(const StoredFile&) = delete;

  const std::filesystem::path& file() const { return file_; }
  /// Returns how many bytes the file had when it was opened.
  std::uint64_t size() const { return size_; }
  /// Fills `bytes` from byte `at` of the file. It waits for the disk. A file that ends before them is
  /// refused, as is one that cannot be read.
  Result<Done> read(std::uint64_t at, std::span<std::byte> bytes) const;

 private:
  StoredFile(std::filesystem::path file, int handle, std::uint64_t size)
      : file_(std::move(file)), handle_(handle), size_(size) {}
  std::filesystem::path file_;
  int handle_;
  std::uint64_t size_;
};

}  // namespace trimtab::terrain
