#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "trimtab/terrain/format/stored_file.h"

namespace trimtab::terrain {

/// Rows of equal size in a file. Each block of rows has a checksum, which is checked when the block is read,
/// so that opening takes the same time for any size of file. Blocks stay in memory up to a limit; beyond it
/// the one that was read first is dropped, and is checked again if it is read again.
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
  static constexpr std::size_t kMostBytes = std::size_t{64} << 20;
  /// `sums`: one per block. The file must have `rowBytes` x `rows` bytes. `mostBytes`: how much stays in
  /// memory.
  CheckedRows(std::shared_ptr<const StoredFile> file, std::size_t rowBytes, std::uint32_t rows,
              std::vector<std::uint64_t> sums, Sound sound, std::size_t mostBytes = kMostBytes);

  /// Reads rows; for one thread. It keeps the last blocks that it used, so that neighbouring rows cost
  /// nothing.
  class Reader {
   public:
    explicit Reader(const CheckedRows& rows) : rows_(rows) {}
    /// Returns a row, which is valid until the next call, or null if its block is damaged.
    const std::byte* row(std::uint32_t row) {
      const std::uint32_t number = row / rows_.perBlock_;
      Held& held = held_[number % held_.size()];
      if (held.number != number) held = {number, rows_.block(number)};
      if (!held.block) return nullptr;
      return held.block->data() + std::size_t{row - number * rows_.perBlock_} * rows_.rowBytes_;
    }

   private:
    struct Held {
      std::uint32_t number = ~0u;
      std::shared_ptr<const std::vector<std::byte>> block;
    };
    const CheckedRows& rows_;
    std::array<Held, 4> held_;
  };

  std::uint32_t rows() const { return rows_; }
  /// Checks every block that was not found damaged before.
  void checkAll() const;
  /// Returns the damage found so far, at most 20 findings. It is thread-safe.
  Findings damage() const;

 private:
  using Block = std::vector<std::byte>;
  struct Slot {
    std::shared_ptr<const Block> block;
    bool damaged = false;
  };
  /// Returns a block, or null if it is damaged. It is thread-safe.
  std::shared_ptr<const Block> block(std::uint32_t number) const;
  /// Reads and checks; null if the bytes are not what was written, which is then a finding.
  std::shared_ptr<const Block> readBlock(std::uint32_t number, Findings& findings) const;

  std::shared_ptr<const StoredFile> file_;
  std::size_t rowBytes_;
  std::uint32_t rows_, perBlock_;
  std::vector<std::uint64_t> sums_;
  Sound sound_;
  bool unchecked_;  ///< see Unchecked
  std::size_t mostBlocks_;
  mutable std::mutex mutex_;
  mutable std::vector<Slot> slots_;
  mutable std::deque<std::uint32_t> inMemory_;  ///< in the order in which they were read
  mutable Findings damage_;
};

}  // namespace trimtab::terrain
