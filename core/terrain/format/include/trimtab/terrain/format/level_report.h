#pragma once

#include <cstdint>
#include <vector>

#include "trimtab/frame/terrain_index.h"
#include "trimtab/terrain/format/patch_terrain.h"

namespace trimtab::terrain {

/// Figures of one level of a terrain; errors in metres, NaN if not measured.
struct LevelReport {
  std::uint64_t nodes = 0, triangles = 0;  ///< of all nodes; a patch counts by its finest variant
  std::uint64_t bytes = 0;                 ///< on disk, all variants; 0: made when drawn
  double maxErrorM = 0;                    ///< vertical, at the posts: the largest of its nodes
  double rmsErrorM = 0;                    ///< likewise, over all posts of the level
  double bilinearErrorM = 0;               ///< largest over the surface between the posts
};

/// Returns one report per depth, the coarsest first.
std::vector<LevelReport> levelsOf(const PatchTerrain& patches);
/// Returns one report per level, the finest first. Among the errors, only maxErrorM is known.
std::vector<LevelReport> levelsOf(const TerrainIndex& tiles);

}  // namespace trimtab::terrain
