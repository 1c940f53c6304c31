#include "trimtab/terrain/format/static_lod_terrain.h"

#include <algorithm>

namespace trimtab::terrain {

bool hasTexture(const StaticLodTerrain& terrain) {
  return std::any_of(terrain.tiles.begin(), terrain.tiles.end(),
                     [](const StaticLodTile& tile) { return !tile.texture.empty(); });
}

void countStaticLod(StaticLodTerrain& terrain) {
  StaticLodCounts& counts = terrain.counts;
  counts.levels = 0;
  counts.faces = counts.sourceTriangles = counts.lockedMinima = 0;
  for (const StaticLodIndex::Node& node : terrain.index.nodes)
    counts.levels = std::max<std::uint32_t>(counts.levels, node.depth + 1u);
  counts.facesOfLevel.assign(counts.levels, 0);
  for (const StaticLodIndex::Node& node : terrain.index.nodes) {
    counts.faces += node.triangles;
    counts.lockedMinima += node.lockedMinimum;
    const bool leaf = node.children[0] == StaticLodIndex::kNone;
    if (leaf) counts.sourceTriangles += node.triangles;
    for (std::uint32_t level = node.depth; level <= (leaf ? counts.levels - 1 : node.depth); ++level)
      counts.facesOfLevel[level] += node.triangles;
  }
  counts.bytes = terrain.index.size() *
                 (sizeof(StaticLodIndex::Node) + sizeof(Box) + 4 * sizeof(float) + sizeof(StaticLodRange));
  for (const StaticLodTile& tile : terrain.tiles)
    counts.bytes += tile.vertices.size() * sizeof(StaticLodVertex) + tile.indices.size() * 4 +
                    tile.locked.size() + tile.material.size() * 2 + tile.texture.size() * 8;
}

}  // namespace trimtab::terrain
