#pragma once

#include <random>

#include "trimtab/culling/select.h"

namespace trimtab::test {

/// A quadtree of n x n tiles of 1,000 m (n a power of two) with heights and errors by chance; errors grow up
/// the tree.
inline TerrainIndex randomIndex(std::uint32_t n, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> chance(0, 1);
  constexpr std::uint32_t kNone = TerrainIndex::kNone;
  TerrainIndex index;
  for (int level = 0; n >= 1; ++level, n /= 2) {
    const auto first = static_cast<std::uint32_t>(index.level.size());
    const std::uint32_t below = level == 0 ? 0 : index.levels.back().firstNode;
    index.levels.push_back({first, n, n});
    const float width = 1000.0f * static_cast<float>(1 << level);
    for (std::uint32_t row = 0; row < n; ++row)
      for (std::uint32_t column = 0; column < n; ++column) {
        const std::uint32_t node = first + row * n + column;
        const float x = width * static_cast<float>(column), y = width * static_cast<float>(row),
                    z = 900 * chance(random);
        Box box{x, y, z, x + width, y + width, z + 10 + 400 * chance(random)};
        float error = level == 0 ? 0.1f : 0;
        std::array<std::uint32_t, 4> children{kNone, kNone, kNone, kNone};
        if (level > 0) {
          const std::uint32_t c = below + 2 * row * 2 * n + 2 * column;
          children = {c, c + 1, c + 2 * n, c + 2 * n + 1};
          for (const std::uint32_t child : children) {
            box.minZ = std::min(box.minZ, index.bounds[child].minZ);
            box.maxZ = std::max(box.maxZ, index.bounds[child].maxZ);
            error = std::max(error, index.errorM[child] * (1 + 2 * chance(random)));
            index.parent[child] = node;
          }
        }
        index.bounds.push_back(box);
        index.errorM.push_back(error);
        index.slopeMax.push_back(1);
        index.level.push_back(static_cast<std::uint8_t>(level));
        index.parent.push_back(kNone);
        index.children.push_back(children);
        index.neighbours.push_back({column > 0 ? node - 1 : kNone, column + 1 < n ? node + 1 : kNone,
                                    row > 0 ? node - n : kNone, row + 1 < n ? node + n : kNone});
      }
  }
  return index;
}

}  // namespace trimtab::test
