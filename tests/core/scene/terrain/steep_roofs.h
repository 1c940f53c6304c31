#pragma once

#include <cmath>

namespace trimtab::test {

/// Heights of roofs that run from south to north, three tiles up and three down, bent so that the eye sees
/// round them; steep enough that one side of each is seen from behind from below the ridge beyond it.
inline double steepRoofs(int column, int row) {
  const double across = (column + 6 * std::sin(row * 0.03)) / 192.0,
               up = std::abs(across - std::floor(across) - 0.5);
  return 8000 * up + 20 * std::sin(row * 0.05) + 3 * std::sin(column * 0.7);
}

}  // namespace trimtab::test
