#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace trimtab {

/// Reports whether a span is an image of that size: rows without gaps, `channels` bytes per pixel.
inline bool holdsPicture(std::span<const std::uint8_t> bytes, int width, int height, std::size_t channels) {
  return width > 0 && height > 0 &&
         bytes.size() == channels * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
}

}  // namespace trimtab
