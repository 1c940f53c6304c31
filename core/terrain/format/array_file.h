#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "trimtab/frame/terrain_index.h"
#include "trimtab/units/result.h"

/// Little-endian files that are read whole: a header of magic, version, number of bytes that follow and their
/// checksum; then numbers as they are in memory, and arrays with their length in front.
namespace trimtab::terrain {

/// Tells whether a type has no padding, whose bytes would be written without a value. Specialise it for
/// structs with floats, whose fields fill them.
template <class T>
inline constexpr bool kFillsItsBytes =
    std::has_unique_object_representations_v<T> || std::is_same_v<T, float>;
template <class T, std::size_t N>
inline constexpr bool kFillsItsBytes<std::array<T, N>> = kFillsItsBytes<T>;
template <>
inline constexpr bool kFillsItsBytes<Box> = sizeof(Box) == 24;

/// Collects the bytes of a file, with room for its header in front.
class ArrayWriter {
 public:
  static constexpr std::size_t kHeaderBytes = 8 + 4 + 8 + 8;

  template <class T>
  void number(T value) {
    static_assert(std::is_arithmetic_v<T>);
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  template <class T>
  void array(const std::vector<T>& values) {
    static_assert(kFillsItsBytes<T> && std::is_trivially_copyable_v<T>);
    number(std::uint64_t{values.size()});
    bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
  }
  void text(const std::string& value) {
    number(std::uint64_t{value.size()});
    bytes += value;
  }

  std::string bytes = std::string(kHeaderBytes, '\0');
};

/// Stops at the first number or array that would reach past the end; then everything reads as nothing.
class ArrayReader {
 public:
  explicit ArrayReader(std::string_view bytes) : bytes_(bytes) {}
  bool failed() const { return failed_; }
  void refuse() { failed_ = true; }
  bool atEnd() const { return at_ == bytes_.size(); }

  template <class T>
  void number(T& value) {
    if (take(sizeof value)) std::memcpy(&value, bytes_.data() + at_ - sizeof value, sizeof value);
  }
  template <class T>
  void array(std::vector<T>& values) {
    const std::uint64_t count = length(sizeof(T));
    values.resize(count);
    if (count > 0) std::memcpy(values.data(), bytes_.data() + at_, count * sizeof(T));
    at_ += count * sizeof(T);
  }
  void text(std::string& value) {
    const std::uint64_t count = length(1);
    value.assign(bytes_.data() + at_, count);
    at_ += count;
  }
  /// Reads how many things of at least `each` bytes follow; never more than the file can hold.
  std::uint64_t length(std::size_t each) {
    std::uint64_t count = 0;
    number(count);
    if (count > (bytes_.size() - at_) / each) failed_ = true;
    return failed_ ? 0 : count;
  }

 private:
  bool take(std::size_t size) {
    if (failed_ || size > bytes_.size() - at_) return !(failed_ = true);
    at_ += size;
    return true;
  }
  std::string_view bytes_;
  std::size_t at_ = 0;
  bool failed_ = false;
};

/// What a file of arrays calls itself, and the versions that are read.
struct ArrayFileKind {
  std::array<char, 8> magic;
  const char* name;  ///< for messages
  std::uint32_t oldest, newest;
};

/// The bytes after the header of a file whose size and checksum are right.
struct ArrayFileBody {
  std::uint32_t version = 0;
  std::uint64_t sum = 0;
  std::string bytes;
};

/// Fills in the header and writes the file atomically. Returns the body's checksum.
Result<std::uint64_t> writeArrayFile(const std::filesystem::path& file, const ArrayFileKind& kind,
                                     std::uint32_t version, ArrayWriter writer);
/// Reads a file; its size is checked before memory is allocated for it.
Result<ArrayFileBody> readArrayFile(const std::filesystem::path& file, const ArrayFileKind& kind);
/// Reports arrays that end before or after their file; empty if they end with it.
Findings endFindings(const std::filesystem::path& file, const ArrayReader& reader);
/// Reports numbers that do not agree with each other; `fault` names them.
Finding faultFinding(const std::filesystem::path& file, std::string fault);

}  // namespace trimtab::terrain
