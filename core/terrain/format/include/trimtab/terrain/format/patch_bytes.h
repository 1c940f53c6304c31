#pragma once

#include <cstddef>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

#include "trimtab/terrain/format/patch_terrain.h"

/// Writes and reads what is known about patches as bytes, one kind after the other, for exactly as many
/// variants as there are.
namespace trimtab::terrain {

/// The bytes of PatchFacts before the values per variant, of which there may be fewer than PatchFacts holds.
inline constexpr std::size_t kPlainFactBytes = offsetof(PatchFacts, rmsErrorM);
static_assert(kPlainFactBytes == 24 &&
              sizeof(PatchFacts) == kPlainFactBytes + 2 * PatchIndex::kMostVariants * sizeof(float));
constexpr std::size_t factBytes(std::size_t variants) {
  return kPlainFactBytes + 2 * variants * sizeof(float);
}

class PatchBytesWriter {
 public:
  /// Reserves memory for so many bytes.
  explicit PatchBytesWriter(std::size_t bytes) { bytes_.reserve(bytes); }

  template <class T>
  void add(std::span<const T> values) {
    static_assert(std::is_trivially_copyable_v<T>);
    append(values.data(), values.size_bytes());
  }
  void add(std::span<const PatchFacts> facts, std::size_t variants) {
    for (const PatchFacts& of : facts) {
      append(&of, kPlainFactBytes);
      append(of.rmsErrorM.data(), variants * sizeof(float));
      append(of.bilinearErrorM.data(), variants * sizeof(float));
    }
  }
  std::span<const std::byte> bytes() const { return bytes_; }

 private:
  void append(const void* from, std::size_t size) {
    const auto* const first = static_cast<const std::byte*>(from);
    bytes_.insert(bytes_.end(), first, first + size);
  }
  std::vector<std::byte> bytes_;
};

/// Reads it again in the order in which it was written. A value beyond the end is left unchanged.
class PatchBytesReader {
 public:
  explicit PatchBytesReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  template <class T>
  void take(std::span<T> values) {
    static_assert(std::is_trivially_copyable_v<T>);
    take(values.data(), values.size_bytes());
  }
  void take(std::span<PatchFacts> facts, std::size_t variants) {
    for (PatchFacts& of : facts) {
      take(&of, kPlainFactBytes);
      take(of.rmsErrorM.data(), variants * sizeof(float));
      take(of.bilinearErrorM.data(), variants * sizeof(float));
    }
  }
  /// Reports whether all bytes were read, and none was missing.
  bool isWhole() const { return enough_ && bytes_.empty(); }

 private:
  void take(void* to, std::size_t size) {
    enough_ = enough_ && size <= bytes_.size();
    if (!enough_ || size == 0) return;
    std::memcpy(to, bytes_.data(), size);
    bytes_ = bytes_.subspan(size);
  }
  std::span<const std::byte> bytes_;
  bool enough_ = true;
};

}  // namespace trimtab::terrain
