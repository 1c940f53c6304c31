#include <algorithm>
#include <bit>

#include "trimtab/terrain/format/static_lod_terrain.h"
#include "trimtab/terrain/static_lod/level.h"
#include "trimtab/terrain/static_lod/static_lod.h"

namespace trimtab::terrain {

StaticLodLimits staticLodLimits(std::uint64_t triangles, std::uint32_t trianglesPerNode) {
  const std::uint64_t n = trianglesPerNode;
  const std::uint64_t fewest = std::max<std::uint64_t>(1, (triangles + n - 1) / n);
  const std::uint64_t most = std::max(fewest, triangles / std::max<std::uint64_t>(1, n / 2));
  return {static_cast<std::uint32_t>(1 + std::bit_width(fewest - 1)), triangles + (fewest - 1) * (n - 1),
          triangles + (most - 1) * (n + 1)};
}

StaticLodReport reportStaticLod(const StaticLodTerrain& terrain, std::size_t tile) {
  const StaticLodIndex& index = terrain.index;
  StaticLodReport report;
  report.tile = terrain.tiles[tile].name;
  report.trianglesPerNode = terrain.trianglesPerNode;
  report.levels = levelsOf(terrain, tile);
  report.facesOfLevel.assign(report.levels, 0);
  report.rmsErrorM.assign(report.levels, 0);
  report.maxErrorM.assign(report.levels, 0);
  for (std::size_t i = 0; i < index.size(); ++i) {
    const StaticLodIndex::Node& node = index.nodes[i];
    if (node.tile != tile) continue;
    report.faces += node.triangles;
    report.lockedMinima += node.lockedMinimum;
    const bool leaf = node.children[0] == StaticLodIndex::kNone;
    if (leaf) report.triangles += node.triangles;
    report.rmsErrorM[node.depth] = std::max<double>(report.rmsErrorM[node.depth], index.rmsErrorM[i]);
    report.maxErrorM[node.depth] = std::max<double>(report.maxErrorM[node.depth], index.maxErrorM[i]);
    for (std::uint32_t level = node.depth; level <= (leaf ? report.levels - 1 : node.depth); ++level)
      report.facesOfLevel[level] += node.triangles;
  }
  report.limits = staticLodLimits(report.triangles, report.trianglesPerNode);
  return report;
}

std::size_t tileNearest(const StaticLodTerrain& terrain, std::uint64_t triangles) {
  std::vector<std::uint64_t> source(terrain.tiles.size());
  for (const StaticLodIndex::Node& node : terrain.index.nodes)
    if (node.children[0] == StaticLodIndex::kNone) source[node.tile] += node.triangles;
  const auto away = [&](std::uint64_t count) {
    return count > triangles ? count - triangles : triangles - count;
  };
  return static_cast<std::size_t>(
      std::min_element(source.begin(), source.end(),
                       [&](std::uint64_t a, std::uint64_t b) { return away(a) < away(b); }) -
      source.begin());
}

}  // namespace trimtab::terrain
