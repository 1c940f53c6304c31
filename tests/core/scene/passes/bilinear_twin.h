#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace trimtab::test {

/// Returns one channel of pixel (x, y) of an image of `width` x `height`, scaled up from RGBA of another size
/// between the middles of its pixels, in doubles: the twin of what the renderer does.
inline double scaledUp(const std::vector<std::uint8_t>& rgba, int fromWidth, int fromHeight, int width,
                       int height, int x, int y, int channel) {
  const double u = std::clamp((x + 0.5) * fromWidth / width - 0.5, 0.0, fromWidth - 1.0),
               v = std::clamp((y + 0.5) * fromHeight / height - 0.5, 0.0, fromHeight - 1.0);
  const auto at = [&](double i, double j) {
    const int column = std::min(int(i), fromWidth - 1), row = std::min(int(j), fromHeight - 1);
    return double(rgba[static_cast<std::size_t>((row * fromWidth + column) * 4 + channel)]);
  };
  const double i = std::floor(u), j = std::floor(v), a = u - i, b = v - j;
  return (1 - b) * ((1 - a) * at(i, j) + a * at(i + 1, j)) +
         b * ((1 - a) * at(i, j + 1) + a * at(i + 1, j + 1));
}

}  // namespace trimtab::test
