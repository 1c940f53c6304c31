#include "trimtab/culling/box_distance.h"
#include "trimtab/culling/select.h"
#include "trimtab/culling/tree_walk.h"

namespace trimtab {
namespace {

bool isSplit(const LevelCut& cut, std::uint32_t node) {
  return node != TerrainIndex::kNone && cut.split[node] != 0;
}

void split(const TerrainIndex& index, std::uint32_t node, LevelCut& cut) {
  if (node == TerrainIndex::kNone || cut.split[node] || index.level[node] == 0) return;
  cut.split[node] = 1;
  cut.splitNodes[index.level[node]].push_back(node);
}

/// Splits nodes whose error is too large, from the roots down, so that only the part of the tree in use is
/// visited.
void splitByError(const TerrainIndex& index, Vec3 eye, const CutRule& rule, LevelCut& cut) {
  const double limit = rule.limit();
  while (!cut.stack.empty()) {
    const std::uint32_t node = cut.stack.back();
    cut.stack.pop_back();
    if (!rule.isTooCoarse(index.errorM[node], distanceSquared(index.bounds[node], eye), limit)) continue;
    split(index, node, cut);
    if (!cut.split[node]) continue;
    forEachChild(index, node, [&](std::uint32_t child) { cut.stack.push_back(child); });
  }
}

/// Splits nodes until neighbours differ by one level at most. A split node's neighbours must be in the tree,
/// so their parents must be split. Goes from the finest level to the coarsest, because each split is added
/// one level up.
void restrictNeighbours(const TerrainIndex& index, LevelCut& cut) {
  for (auto& nodes : cut.splitNodes)
    for (const std::uint32_t node : nodes) {
      split(index, index.parent[node], cut);
      for (const std::uint32_t neighbour : index.neighbours[node])
        if (neighbour != TerrainIndex::kNone) split(index, index.parent[neighbour], cut);
    }
}

std::uint8_t coarserSides(const TerrainIndex& index, const LevelCut& cut, std::uint32_t node) {
  std::uint8_t bits = 0;
  for (std::size_t side = 0; side < 4; ++side) {
    const std::uint32_t neighbour = index.neighbours[node][side];
    if (neighbour == TerrainIndex::kNone || index.parent[neighbour] == TerrainIndex::kNone) continue;
    if (!isSplit(cut, index.parent[neighbour])) bits = static_cast<std::uint8_t>(bits | (1u << side));
  }
  return bits;
}

}  // namespace

void selectLevels(const TerrainIndex& index, Vec3 eye, const CutRule& rule, LevelCut& cut) {
  cut.tiles.clear();
  cut.split.assign(index.size(), 0);
  cut.splitNodes.resize(index.levels.size());
  for (auto& nodes : cut.splitNodes) nodes.clear();

  cut.stack.clear();
  const auto push = [&](std::uint32_t root) { cut.stack.push_back(root); };
  forEachRoot(index, push);
  splitByError(index, eye, rule, cut);
  restrictNeighbours(index, cut);

  forEachRoot(index, push);
  takeCut(
      index, cut.stack, [&](std::uint32_t node) { return cut.split[node] != 0; },
      [&](std::uint32_t node) {
        cut.tiles.push_back({node, BorderMask(coarserSides(index, cut, node))});
      });
  gather(index, cut);
}

}  // namespace trimtab
