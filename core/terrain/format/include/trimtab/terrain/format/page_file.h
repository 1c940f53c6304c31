#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "trimtab/units/result.h"

/// Stores blobs under numbers in one file, for pages of meshes and of ground colours.
///
/// The file has a header, blobs that begin at multiples of 16 bytes, and a table, ordered by key, with key,
/// place, size and checksum of each. The header has the place and the checksum of the table, and its own
/// checksum. All numbers are little-endian.
namespace trimtab::terrain {

class PageFile {
 public:
  /// Opens a file and checks its header and table. Blobs are checked when they are read.
  static Result<std::shared_ptr<const PageFile>> open(const std::filesystem::path& file);
  virtual ~PageFile() = default;

  virtual std::size_t size() const = 0;     ///< how many blobs
  virtual std::uint64_t bytes() const = 0;  ///< of the file
  /// Returns the checksum of the table, which covers the whole file through the checksums in it.
  virtual std::uint64_t checksum() const = 0;
  virtual bool has(std::uint64_t key) const = 0;
  virtual std::uint64_t bytesOf(std::uint64_t key) const = 0;  ///< 0 if there is no such blob
  /// Returns a copy of a blob after comparing its checksum. It waits for the disk. Safe on any thread.
  virtual Result<std::vector<std::byte>> read(std::uint64_t key) const = 0;
  /// Returns the blobs that could not be read so far, or were not what was written; at most 20. Safe on any
  /// thread.
  virtual Findings damage() const = 0;
  /// Compares the checksum of every blob.
  virtual Result<Done> checkAll() const = 0;
};

/// Writes a page file beside `file`, which it replaces in finish(). Without finish() the destructor removes
/// what was written.
class PageFileWriter {
 public:
  static Result<std::unique_ptr<PageFileWriter>> create(const std::filesystem::path& file);
  virtual ~PageFileWriter() = default;
  /// Adds a blob. Keys may come in any order, each once; blobs are stored in the order of the calls. Safe on
  /// any thread.
  virtual Result<Done> add(std::uint64_t key, std::span<const std::byte> blob) = 0;
  virtual Result<Done> finish() = 0;
};

}  // namespace trimtab::terrain
