#include <algorithm>
#include <array>
#include <bit>
#include <utility>
#include <vector>

#include "faces.h"
#include "trimtab/terrain/format/static_lod_terrain.h"
#include "trimtab/terrain/static_lod/level.h"
#include "trimtab/terrain/static_lod/static_lod.h"

namespace trimtab::terrain {

namespace {

/// The triangles that a leaf may hold.
struct LeafRange {
  std::uint64_t least, most;
};
LeafRange leafRange(std::uint64_t n, LeafReading reading) {
  if (reading == LeafReading::atLeast) return {n, 2 * n};
  return {std::max<std::uint64_t>(1, n / 2), n};
}

std::uint64_t distinctFaces(const StaticLodTile& tile) {
  FaceCount<std::array<float, 3>> faces;
  const auto place = [&](std::size_t i) {
    const StaticLodVertex& v = tile.vertices[tile.indices[i]];
    return std::array<float, 3>{v.x, v.y, v.z};
  };
  for (std::size_t t = 0; t < tile.material.size(); ++t)
    faces.add({place(3 * t), place(3 * t + 1), place(3 * t + 2)}, tile.material[t]);
  return faces.distinct();
}

}  // namespace

StaticLodLimits staticLodLimits(std::uint64_t triangles, std::uint32_t trianglesPerNode,
                                LeafReading reading) {
  const std::uint64_t n = trianglesPerNode;
  const LeafRange leaf = leafRange(n, reading);
  const std::uint64_t fewest = std::max<std::uint64_t>(1, (triangles + leaf.most - 1) / leaf.most);
  const std::uint64_t most = std::max(fewest, triangles / leaf.least);
  return {static_cast<std::uint32_t>(1 + std::bit_width(fewest - 1)), triangles + (fewest - 1) * (n - 1),
          triangles + (most - 1) * (n + 1)};
}

HalvedTree halvedTree(std::uint64_t triangles, std::uint32_t trianglesPerNode, LeafReading reading) {
  HalvedTree tree{1, triangles, 1, triangles};
  // A half of 2 m + 1 triangles is m + 1 at most.
  for (const std::uint64_t most = leafRange(trianglesPerNode, reading).most; tree.largestLeaf > most;
       ++tree.levels)
    tree.largestLeaf -= tree.largestLeaf / 2, tree.leaves *= 2;
  tree.faces += (tree.leaves - 1) * trianglesPerNode;
  return tree;
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
  report.distinctFaces = distinctFaces(terrain.tiles[tile]);
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
