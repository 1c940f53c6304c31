#include "trimtab/terrain/format/level_report.h"
#include "trimtab/units/not_finite.h"

#include <algorithm>
#include <cmath>

namespace trimtab::terrain {

std::vector<LevelReport> levelsOf(const PatchTerrain& patches) {
  const PatchIndex& index = patches.index();
  std::vector<LevelReport> levels;
  std::vector<double> posts;
  for (std::size_t i = 0; i < index.size(); ++i) {
    const std::size_t depth = index.depth[i];
    if (depth >= levels.size()) {
      levels.resize(depth + 1);
      posts.resize(depth + 1);
    }
    const PatchFacts& facts = patches.facts()[i];
    LevelReport& level = levels[depth];
    ++level.nodes;
    level.triangles += index.triangles[i][0];
    level.bytes += facts.bytes;
    level.maxErrorM = std::max(level.maxErrorM, double{index.errorM[i][0]});
    level.bilinearErrorM = std::max(level.bilinearErrorM, double{facts.bilinearErrorM[0]});
    level.rmsErrorM += double{facts.rmsErrorM[0]} * facts.rmsErrorM[0] * facts.posts;
    posts[depth] += facts.posts;
  }
  for (std::size_t depth = 0; depth < levels.size(); ++depth)
    levels[depth].rmsErrorM = posts[depth] > 0 ? std::sqrt(levels[depth].rmsErrorM / posts[depth]) : 0;
  return levels;
}

std::vector<LevelReport> levelsOf(const TerrainIndex& tiles) {
  constexpr std::uint64_t kTrianglesPerTile = 2 * TerrainIndex::kTileCells * TerrainIndex::kTileCells;
  std::vector<LevelReport> levels;
  for (const TerrainIndex::Level& level : tiles.levels) {
    LevelReport report{.rmsErrorM = kNan, .bilinearErrorM = kNan};
    report.nodes = std::uint64_t{level.columns} * level.rows;
    report.triangles = report.nodes * kTrianglesPerTile;
    for (std::uint64_t node = level.firstNode; node < level.firstNode + report.nodes; ++node)
      report.maxErrorM = std::max(report.maxErrorM, double{tiles.errorM[node]});
    levels.push_back(report);
  }
  return levels;
}

}  // namespace trimtab::terrain
