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

/// One level of what is drawn: of tiles 0 is the finest, of patches (their depth) the coarsest.
struct TerrainLevel {
  std::uint64_t nodes = 0, triangles = 0;  ///< of all nodes, each by its finest mesh
  std::uint64_t bytes = 0;                 ///< on disk; 0: made when it is drawn
  double maxErrorM = 0, rmsErrorM = 0;     ///< at the posts: the largest, and over all. NaN: not measured
  double surfaceErrorM = 0;                ///< largest over the surface between the posts; NaN likewise
};

/// What the dock says of a terrain.
struct TerrainSummary {
  QString name, source;
  std::uint64_t columns = 0, rows = 0, voidsFilled = 0, bytes = 0;
  double postM = 0;  ///< distance of posts, north
  double lowestM = 0, highestM = 0, southDeg = 0, westDeg = 0, northDeg = 0, eastDeg = 0;
  std::vector<TerrainLevel> tiles, patches;  ///< empty where it has none
};

/// The Terrain dock: opening and baking, what the terrain is, its levels and their errors, and what of them
/// is drawn now.
class TerrainPanel : public QWidget {
  Q_OBJECT
 public:
  explicit TerrainPanel(Draft& draft, QWidget* parent = nullptr);

  /// Buttons for what the menus do: opening and baking in the first row, how levels are shown in the second.
  void setActions(const QList<QAction*>& files, const QList<QAction*>& overlays);
  /// None: no terrain yet.
  void setTerrain(std::optional<TerrainSummary> terrain);
  /// Long work: its share done, or that it is over.
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
  std::optional<bool> shownPatches_;  ///< whose levels the table has
  LiveFrame frame_;
  Throttle throttle_;
};

}  // namespace trimtab::views
