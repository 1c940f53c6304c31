#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace trimtab {

/// Computes SHA-256 (FIPS 180-4) of bytes that are added in pieces.
class Sha256 {
 public:
  /// Adds any number of bytes.
  void add(std::string_view bytes);
  /// Ends the sum and returns it as 64 lower-case hexadecimal digits. Call it once, after the last add().
  std::string hex();

 private:
  void block(const unsigned char* bytes);

  std::array<std::uint32_t, 8> state_{0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                      0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::array<unsigned char, 64> pending_{};
  std::uint64_t size_ = 0;  ///< bytes so far
};

}  // namespace trimtab
