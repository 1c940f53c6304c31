#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "trimtab/host/byte_order.h"

namespace trimtab {

/// Writes CIGI packets one after another.
class PacketWriter {
 public:
  explicit PacketWriter(ByteOrder order) : order_(order) {}

  /// Appends a zeroed packet; offsets of `put` count from its start.
  void begin(std::uint8_t id, std::size_t size) {
    start_ = bytes_.size();
    bytes_.resize(start_ + size);
    put(0, id);
    put(1, static_cast<std::uint8_t>(size));
  }
  template <class T>
  void put(std::size_t offset, T value) {
    wire::put<T>(bytes_, start_ + offset, order_, value);
  }
  void putFloat(std::size_t offset, double value) { put(offset, static_cast<float>(value)); }
  std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  ByteOrder order_;
  std::size_t start_ = 0;
  std::vector<std::byte> bytes_;
};

constexpr std::uint8_t bits(unsigned value) {
  return static_cast<std::uint8_t>(value);
}

}  // namespace trimtab
