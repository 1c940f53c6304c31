#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "trimtab/units/result.h"

/// Numbered blobs in one file: what pages of meshes and of ground colours are kept in.
///
/// Header, blobs from multiples of 16 bytes, then the table (key, place, bytes, checksum of each, by key);
/// the header has the table's place and checksum, and its own. All little-endian. Readers map the file: any
/// number of programs share one copy in memory.
namespace trimtab::terrain {

class PageFile {
 public:
  /// Maps a file and checks header and table. Blobs are checked when they are read.
  static Result<std::shared_ptr<const PageFile>> open(const std::filesystem::path& file);
  virtual ~PageFile() = default;

  virtual std::size_t size() const = 0;     ///< blobs
  virtual std::uint64_t bytes() const = 0;  ///< of the file
  /// Of the table, and so of all that is in the file.
  virtual std::uint64_t checksum() const = 0;
  virtual bool has(std::uint64_t key) const = 0;
  virtual std::uint64_t bytesOf(std::uint64_t key) const = 0;  ///< 0 where it is not there
  /// The blob, its checksum compared; valid while the file is. Waits for the disk. Thread-safe.
  virtual Result<std::span<const std::byte>> read(std::uint64_t key) const = 0;
  /// A blob that was read need not stay in memory; what `read` gave is still good.
  virtual void forget(std::uint64_t key) const = 0;
  /// Every blob's checksum.
  virtual Result<Done> checkAll() const = 0;
};

/// Writes beside `file` and takes its name when finished; what was not finished is gone with the writer.
class PageFileWriter {
 public:
  static Result<std::unique_ptr<PageFileWriter>> create(const std::filesystem::path& file);
  virtual ~PageFileWriter() = default;
  /// Keys may come in any order, each once; blobs lie in the order in which they come. Thread-safe.
  virtual Result<Done> add(std::uint64_t key, std::span<const std::byte> blob) = 0;
  virtual Result<Done> finish() = 0;
};

}  // namespace trimtab::terrain
