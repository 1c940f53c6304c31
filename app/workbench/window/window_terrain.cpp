// SPDX-License-Identifier: GPL-3.0-or-later
#include <QFileInfo>
#include <algorithm>

#include "app/workbench/dialogs/bake_dialog.h"
#include "main_window.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/terrain/bake/bake.h"
#include "trimtab/terrain/format/database.h"
#include "trimtab/terrain/format/level_report.h"
#include "views/panels/terrain_panel.h"

// The Terrain dock: what it says of the terrain, and baking.
namespace trimtab::workbench {
namespace {

std::vector<views::TerrainLevel> levelsFrom(const std::vector<terrain::LevelReport>& reports) {
  std::vector<views::TerrainLevel> levels;
  for (const terrain::LevelReport& r : reports)
    levels.push_back({r.nodes, r.triangles, r.bytes, r.maxErrorM, r.rmsErrorM, r.bilinearErrorM});
  return levels;
}

views::TerrainSummary summaryOf(const terrain::Database& database) {
  const terrain::TerrainInfo& info = database.info();
  const double metresPerDegree = 111.2e3;
  views::TerrainSummary summary{.name = QString::fromStdString(info.name),
                                .source = QString::fromStdString(info.source),
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

}  // namespace

views::TerrainPanel* MainWindow::makeTerrainPanel() {
  auto* panel = new views::TerrainPanel(draft_);
  connect(panel, &views::TerrainPanel::cancelAsked, &terrainJob_, &TerrainJob::cancel);
  connect(&terrainJob_, &TerrainJob::started, panel,
          [panel](const QString& what) { panel->showJob(0, what); });
  connect(&terrainJob_, &TerrainJob::progressed, panel, &views::TerrainPanel::showJob);
  connect(&terrainJob_, &TerrainJob::opened, panel, &views::TerrainPanel::endJob);
  connect(&terrainJob_, &TerrainJob::failed, panel, &views::TerrainPanel::endJob);
  connect(&terrainJob_, &TerrainJob::cancelled, panel, &views::TerrainPanel::endJob);
  return panel;
}

void MainWindow::showTerrain() {
  terrainPanel_->setTerrain(summaryOf(*terrain_));
}

void MainWindow::askBake(const QStringList& sources) {
  BakeDialog dialog(this);
  dialog.addSources(sources);
  if (dialog.exec() != QDialog::Accepted) return;
  terrain::BakeOptions options = dialog.options();
  terrainSource_ = QFileInfo(QString::fromStdString(options.output.string())).absoluteFilePath();
  terrainJob_.bake(std::move(options));
}

LevelsFrame MainWindow::levelsDrawn(const FrameResult& result) const {
  LevelsFrame levels;
  if (!terrain_ || result.staticLod.drawn) return levels;
  const auto patches = terrain_->patches();
  if (result.patches && !patches) return levels;
  const TerrainIndex& tiles = terrain_->index();
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
