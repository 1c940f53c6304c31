// SPDX-License-Identifier: GPL-3.0-or-later
#include "terrain_summary.h"

#include <algorithm>

#include "trimtab/scene/osg_database.h"
#include "trimtab/terrain/format/level_report.h"
#include "trimtab/terrain/format/patch_terrain.h"
#include "trimtab/terrain/format/static_lod_terrain.h"

namespace trimtab::workbench {
namespace {

std::vector<views::TerrainLevel> levelsFrom(const std::vector<terrain::LevelReport>& reports) {
  std::vector<views::TerrainLevel> levels;
  for (const terrain::LevelReport& r : reports)
    levels.push_back({r.nodes, r.triangles, r.bytes, r.maxErrorM, r.rmsErrorM, r.bilinearErrorM});
  return levels;
}

}  // namespace

views::TerrainSummary summaryOf(const terrain::Database& database) {
  const terrain::TerrainInfo& info = database.info();
  const double metresPerDegree = 111.2e3;
  views::TerrainSummary summary{.name = QString::fromStdString(info.name),
                                .source = QString::fromStdString(info.source),
                                .osgScene = dynamic_cast<const scene::OsgDatabase*>(&database) != nullptr,
                                .columns = info.columns,
                                .rows = info.rows,
                                .voidsFilled = info.voidsFilled,
                                .bytes = info.bytes,
                                .postM = info.postLatitude.value() * metresPerDegree,
                                .lowestM = info.lowest.value(),
                                .highestM = info.highest.value(),
                                .southDeg = info.southWest.latitude.value(),
                                .westDeg = info.southWest.longitude.value(),
                                .northDeg = info.northEast.latitude.value(),
                                .eastDeg = info.northEast.longitude.value(),
                                .tiles = levelsFrom(terrain::levelsOf(database.index())),
                                .patches = {}};
  if (const auto patches = database.patches()) summary.patches = levelsFrom(terrain::levelsOf(*patches));
  return summary;
}

std::optional<views::StaticLodSummary> treesOf(const terrain::Database& database) {
  const auto trees = database.staticLod();
  if (!trees) return std::nullopt;
  const terrain::StaticLodCounts& c = trees->counts;
  return views::StaticLodSummary{.trianglesPerNode = trees->trianglesPerNode,
                                 .levels = c.levels,
                                 .tiles = trees->tiles.size(),
                                 .nodes = trees->index.size(),
                                 .sourceTriangles = c.sourceTriangles,
                                 .faces = c.faces,
                                 .distinctFaces = c.distinctFaces,
                                 .lockedMinima = c.lockedMinima,
                                 .bytes = c.bytes,
                                 .facesOfLevel = c.facesOfLevel};
}

LevelsFrame levelsDrawn(const FrameResult& result, const terrain::Database& database) {
  LevelsFrame levels;
  if (result.staticLod.drawn) return levels;
  const auto patches = database.patches();
  if (result.patches && !patches) return levels;
  const TerrainIndex& tiles = database.index();
  const std::size_t known = result.patches ? patches->index().size() : tiles.size();
  constexpr std::uint64_t kTrianglesPerTile = 2 * TerrainIndex::kTileCells * TerrainIndex::kTileCells;
  for (const TileDraw& drawn : result.visible.tiles) {
    if (drawn.node >= known) continue;
    const std::size_t level =
        std::min<std::size_t>(result.patches ? patches->index().depth[drawn.node] : tiles.level[drawn.node],
                              LevelsFrame::kLevels - 1);
    ++levels.nodes[level];
    levels.triangles[level] +=
        result.patches ? patches->index().triangles[drawn.node][drawn.variant.number] : kTrianglesPerTile;
  }
  return levels;
}

}  // namespace trimtab::workbench
