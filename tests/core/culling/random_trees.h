#pragma once

#include <algorithm>
#include <random>

#include "trimtab/frame/static_lod_index.h"

namespace trimtab::test {

/// `tiles` x `tiles` binary trees of uneven depth over squares of `tileM`, split across the longer side;
/// leaves have random heights and errors, parents enclose and exceed them.
inline StaticLodIndex randomTrees(int tiles, unsigned seed, double tileM = 8000, int deepest = 7) {
  StaticLodIndex index;
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> chance(0, 1);
  const auto grow = [&](const auto& self, Box area, std::uint32_t tile, int depth) -> std::uint32_t {
    const auto node = static_cast<std::uint32_t>(index.size());
    index.nodes.push_back({{StaticLodIndex::kNone, StaticLodIndex::kNone},
                           tile,
                           500 + static_cast<std::uint32_t>(1500 * chance(random)),
                           static_cast<std::uint8_t>(depth),
                           false});
    index.bounds.push_back(area);
    index.rmsErrorM.push_back(0);
    index.maxErrorM.push_back(0);
    index.borderErrorM.push_back(0);
    index.slopeMax.push_back(1);
    if (depth == deepest || (depth > 2 && chance(random) < 0.2f)) {
      index.bounds[node].minZ = 900 * chance(random);
      index.bounds[node].maxZ = index.bounds[node].minZ + 300 * chance(random);
      return node;
    }
    Box low = area, high = area;
    if (area.maxX - area.minX >= area.maxY - area.minY)
      low.maxX = high.minX = area.minX + (0.3f + 0.4f * chance(random)) * (area.maxX - area.minX);
    else
      low.maxY = high.minY = area.minY + (0.3f + 0.4f * chance(random)) * (area.maxY - area.minY);
    const std::uint32_t a = self(self, low, tile, depth + 1), b = self(self, high, tile, depth + 1);
    index.nodes[node].children = {a, b};
    index.bounds[node].minZ = std::min(index.bounds[a].minZ, index.bounds[b].minZ);
    index.bounds[node].maxZ = std::max(index.bounds[a].maxZ, index.bounds[b].maxZ);
    index.rmsErrorM[node] =
        std::max(index.rmsErrorM[a], index.rmsErrorM[b]) * (1 + chance(random)) + chance(random);
    index.maxErrorM[node] =
        std::max({index.maxErrorM[a], index.maxErrorM[b], index.rmsErrorM[node] * (2 + 3 * chance(random))});
    // Now below, now between, now above the others, without drawing another random number.
    index.borderErrorM[node] = std::max(
        {index.borderErrorM[a], index.borderErrorM[b], index.rmsErrorM[node] * static_cast<float>(node % 7)});
    return node;
  };
  for (int row = 0; row < tiles; ++row)
    for (int column = 0; column < tiles; ++column) {
      const auto m = [&](int i) { return static_cast<float>(i * tileM); };
      index.roots.push_back(grow(grow, Box{m(column), m(row), 0, m(column + 1), m(row + 1), 0},
                                 static_cast<std::uint32_t>(index.roots.size()), 0));
    }
  return index;
}

}  // namespace trimtab::test
