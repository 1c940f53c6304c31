// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QWidget>
#include <cstdint>
#include <optional>
#include <vector>

#include "views/model/draft.h"
#include "views/model/live.h"
#include "views/model/throttle.h"

class QAction;
class QHBoxLayout;
class QLabel;
class QProgressBar;
class QPushButton;
class QTableView;

namespace trimtab::views {

class TerrainLevelsModel;

/// One level of a terrain: 0 is the finest level of tiles, but the coarsest depth of patches.
struct TerrainLevel {
  std::uint64_t nodes = 0, triangles = 0;  ///< triangles of the finest meshes of all nodes
  std::uint64_t bytes = 0;                 ///< on disk; 0 if it is made when it is drawn
  double maxErrorM = 0, rmsErrorM = 0;     ///< at the posts; NaN if not measured
  double surfaceErrorM = 0;                ///< the worst between the posts; NaN if not measured
};

/// What the dock shows about a terrain.
struct TerrainSummary {
  QString name, source;
  std::uint64_t columns = 0, rows = 0, voidsFilled = 0, bytes = 0;
  double postM = 0;  ///< distance of posts along a meridian
  double lowestM = 0, highestM = 0, southDeg = 0, westDeg = 0, northDeg = 0, eastDeg = 0;
  std::vector<TerrainLevel> tiles, patches;  ///< empty if it has none
};

/// The Terrain dock: buttons for opening and baking, the terrain, its levels with their errors, and what of
/// them is drawn now.
class TerrainPanel : public QWidget {
  Q_OBJECT
 public:
  explicit TerrainPanel(Draft& draft, QWidget* parent = nullptr);

  /// Adds buttons for commands of the menus: opening and baking in the first row, how levels are shown in the
  /// second.
  void setActions(const QList<QAction*>& files, const QList<QAction*>& overlays);
  /// Shows a terrain; nothing if none is open.
  void setTerrain(std::optional<TerrainSummary> terrain);
  /// Shows which share of a long work is done, or that it has ended.
  void showJob(double fraction, const QString& what);
  void endJob();
  void showFrame(const LiveFrame& frame);

 signals:
  void cancelAsked();

 private:
  void refresh();
  void addRow(QHBoxLayout& row, const QList<QAction*>& actions);

  QLabel *summary_, *drawn_, *paging_, *job_;
  QHBoxLayout *fileRow_, *overlayRow_;
  QWidget* jobLine_;
  QProgressBar* bar_;
  QPushButton* cancel_;
  TerrainLevelsModel* levels_;
  QTableView* table_;
  std::optional<TerrainSummary> terrain_;
  std::optional<bool> shownPatches_;  ///< whether the table has the levels of patches; unset if it is empty
  LiveFrame frame_;
  Throttle throttle_;
};

}  // namespace trimtab::views
