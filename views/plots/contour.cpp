// SPDX-License-Identifier: GPL-3.0-or-later
#include "contour.h"

#include <array>

namespace trimtab::views {

std::vector<std::pair<ContourPoint, ContourPoint>> contour(const SampledSurface& s, double level) {
  std::vector<std::pair<ContourPoint, ContourPoint>> pieces;
  if (s.columns < 2 || s.rows < 2) return pieces;
  for (std::size_t y = 0; y + 1 < s.rows; ++y) {
    for (std::size_t x = 0; x + 1 < s.columns; ++x) {
      // Corners and edges are counted counter-clockwise from the lower left; edge i joins corners i and i
      // + 1.
      const std::size_t at = y * s.columns + x;
      const std::array<double, 4> value{s.value[at], s.value[at + 1], s.value[at + s.columns + 1],
                                        s.value[at + s.columns]};
      static constexpr double kX[] = {0, 1, 1, 0}, kY[] = {0, 0, 1, 1};
      std::array<ContourPoint, 4> crossing;
      std::array<std::size_t, 4> edge{};
      std::size_t crossings = 0;
      for (std::size_t i = 0; i < 4; ++i) {
        const std::size_t j = (i + 1) % 4;
        // A corner at the level is above it, so that a contour through samples is drawn once.
        if ((value[i] >= level) == (value[j] >= level)) continue;
        const double t = (level - value[i]) / (value[j] - value[i]);
        crossing[i] = {static_cast<double>(x) + kX[i] + t * (kX[j] - kX[i]),
                       static_cast<double>(y) + kY[i] + t * (kY[j] - kY[i])};
        edge[crossings++] = i;
      }
      if (crossings == 2) pieces.emplace_back(crossing[edge[0]], crossing[edge[1]]);
      if (crossings == 4) {
        const bool middleAbove = (value[0] + value[1] + value[2] + value[3]) / 4 >= level;
        const std::size_t first = middleAbove == (value[0] >= level) ? 1 : 3;
        pieces.emplace_back(crossing[0], crossing[first]);
        pieces.emplace_back(crossing[2], crossing[4 - first]);
      }
    }
  }
  return pieces;
}

}  // namespace trimtab::views
