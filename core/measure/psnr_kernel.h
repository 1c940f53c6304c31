#pragma once

#include "simd.h"

namespace trimtab {
namespace {

std::uint64_t squaredError(const std::uint8_t* a, const std::uint8_t* b, std::size_t pixels) {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < pixels; ++i)
    for (std::size_t c = 0; c < 3; ++c) {
      const int d = a[4 * i + c] - b[4 * i + c];
      sum += static_cast<std::uint32_t>(d * d);
    }
  return sum;
}

}  // namespace
}  // namespace trimtab
