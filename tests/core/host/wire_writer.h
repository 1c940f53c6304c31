#pragma once

#include <string_view>
#include <vector>

#include "trimtab/host/byte_order.h"

namespace trimtab::test {

/// Writes packets after a published table: each field at its offset, one after another.
class WireWriter {
 public:
  explicit WireWriter(ByteOrder order) : order_(order) {}
  /// Appends a zeroed packet; offsets count from its start.
  WireWriter& begin(std::size_t size) {
    start_ = bytes.size();
    bytes.resize(start_ + size);
    return *this;
  }
  template <class T>
  WireWriter& put(std::size_t offset, T value) {
    wire::put<T>(bytes, start_ + offset, order_, value);
    return *this;
  }
  WireWriter& u8(std::size_t offset, unsigned value) { return put(offset, static_cast<std::uint8_t>(value)); }
  WireWriter& u16(std::size_t offset, unsigned value) {
    return put(offset, static_cast<std::uint16_t>(value));
  }
  WireWriter& u32(std::size_t offset, std::uint32_t value) { return put(offset, value); }
  WireWriter& f32(std::size_t offset, double value) { return put(offset, static_cast<float>(value)); }
  WireWriter& f64(std::size_t offset, double value) { return put(offset, value); }
  WireWriter& text(std::size_t offset, std::string_view value) {
    for (std::size_t i = 0; i < value.size(); ++i) u8(offset + i, static_cast<unsigned char>(value[i]));
    return *this;
  }

  std::vector<std::byte> bytes;

 private:
  ByteOrder order_;
  std::size_t start_ = 0;
};

}  // namespace trimtab::test
