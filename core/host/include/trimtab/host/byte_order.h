#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>

namespace trimtab {

enum class ByteOrder { big, little };

/// Functions that read and write numbers at any byte offset of a packet, in the packet's byte order. T is an
/// integer or a floating-point type of 1, 2, 4 or 8 bytes.
namespace wire {

/// Names the unsigned integer of N bytes.
template <std::size_t N>
using Bits = std::conditional_t<
    N == 1, std::uint8_t,
    std::conditional_t<N == 2, std::uint16_t, std::conditional_t<N == 4, std::uint32_t, std::uint64_t>>>;

/// Returns the number whose first byte is at `offset`. The caller must have checked that
/// `offset + sizeof(T) <= bytes.size()`; else the behaviour is undefined.
template <class T>
T get(std::span<const std::byte> bytes, std::size_t offset, ByteOrder order) {
  using U = Bits<sizeof(T)>;
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < sizeof(T); ++i) {
    const std::size_t at = order == ByteOrder::big ? i : sizeof(T) - 1 - i;
    bits = (bits << 8) | std::to_integer<std::uint64_t>(bytes[offset + at]);
  }
  return std::bit_cast<T>(static_cast<U>(bits));
}

/// Writes a number from `offset` on. The caller must have checked that `offset + sizeof(T) <= bytes.size()`;
/// else the behaviour is undefined.
template <class T>
void put(std::span<std::byte> bytes, std::size_t offset, ByteOrder order, T value) {
  const std::uint64_t bits = std::bit_cast<Bits<sizeof(T)>>(value);
  for (std::size_t i = 0; i < sizeof(T); ++i) {
    const std::size_t shift = 8 * (order == ByteOrder::big ? sizeof(T) - 1 - i : i);
    bytes[offset + i] = static_cast<std::byte>((bits >> shift) & 0xff);
  }
}

}  // namespace wire
}  // namespace trimtab
