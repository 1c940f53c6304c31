// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QWidget>
#include <optional>

#include "views/model/draft.h"
#include "views/model/live.h"
#include "views/model/terrain_summary.h"
#include "views/model/throttle.h"

class QAction;
class QHBoxLayout;
class QLabel;
class QProgressBar;
class QPushButton;
class QTableView;

namespace trimtab::views {

class TerrainLevelsModel;

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
