#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "trimtab/terrain/format/mapped_file.h"

namespace trimtab::terrain {

/// Rows of equal size in a mapped file. Each block of rows has a checksum, which is checked when a row of the
/// block is first read, so that opening takes the same time for any size of file.
class CheckedRows {
 public:
  /// Returns how many rows make a block of about a quarter of a megabyte.
  static std::uint32_t rowsPerBlock(std::size_t rowBytes);
  /// Computes the checksums of all blocks. Add the rows in order, any number at a time, then call finish().
  class Sums {
   public:
    explicit Sums(std::size_t rowBytes) : rowBytes_(rowBytes), perBlock_(rowsPerBlock(rowBytes)) {}
    void add(std::span<const std::byte> rows);
    std::vector<std::uint64_t> finish();

   private:
    std::size_t rowBytes_;
    std::uint32_t perBlock_;
    std::vector<std::byte> open_;
    std::vector<std::uint64_t> sums_;
  };

  /// Tells whether the bytes of a block are valid values; if empty, all bytes are.
  using Sound = std::function<bool(std::span<const std::byte>)>;
  /// `sums`: one per block; if empty, nothing is checked. The file must have `rowBytes` x `rows` bytes.
  CheckedRows(std::shared_ptr<const MappedFile> mapped, std::size_t rowBytes, std::uint32_t rows,
              std::vector<std::uint64_t> sums, Sound sound);

  std::uint32_t rows() const { return rows_; }
  /// Returns a row, or null if its block is damaged. Thread-safe.
  const std::byte* row(std::uint32_t row) const {
    if (!isGood(row / perBlock_)) return nullptr;
    return mapped_->bytes().data() + std::size_t{row} * rowBytes_;
  }
  /// Checks every block.
  void checkAll() const;
  /// Returns the damage found so far, at most 20 findings. Thread-safe.
  Findings damage() const;

 private:
  bool isGood(std::uint32_t block) const {
    const std::uint8_t state = states_[block].load(std::memory_order_acquire);
    return state == kGood || (state == kUnknown && check(block));
  }
  bool check(std::uint32_t block) const;

  static constexpr std::uint8_t kUnknown = 0, kGood = 1, kBad = 2;
  std::shared_ptr<const MappedFile> mapped_;
  std::size_t rowBytes_;
  std::uint32_t rows_, perBlock_;
  std::vector<std::uint64_t> sums_;
  Sound sound_;
  std::unique_ptr<std::atomic<std::uint8_t>[]> states_;
  mutable std::mutex mutex_;
  mutable Findings damage_;
};

}  // namespace trimtab::terrain
