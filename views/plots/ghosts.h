// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <qcustomplot.h>

#include <array>

#include "views/model/draft.h"

namespace trimtab::views {

/// An editor draws the values of the file, and those of a pinned snapshot, behind the values that are edited.
inline constexpr std::array kGhosts{Reference::file, Reference::pinned};
/// Returns the pen for one of the two: dotted for the file, dash-dotted for the snapshot.
QPen ghostPen(Reference which, const QPalette& palette);
/// Returns its name in a legend: "file", or the name of the snapshot.
QString ghostName(Reference which, const Draft& draft);

/// The curves that file and snapshot have where those of a plot differ from them. A corner of the plot names
/// them while they are shown; a legend above it would move the plot under a drag.
class Ghosts {
 public:
  /// Make it before the plot's own graphs, which are drawn over it.
  Ghosts(QCustomPlot& plot, const Draft& draft);

  using Line = QVector<QPointF>;
  /// Shows these lines; none hides the ghost.
  void show(Reference which, const QVector<Line>& lines);
  bool isShown(Reference which) const { return of(which)->visible(); }
  void restyle(const QPalette& palette);
  /// Names no ghosts in the corner: the plot says in another way what they are.
  void leaveNamesOut() { named_ = false; }

 private:
  void showNames();
  QCPCurve* of(Reference which) const { return curves_[which == kGhosts[0] ? 0 : 1]; }

  const Draft& draft_;
  bool named_ = true;
  std::array<QCPCurve*, 2> curves_;
  QCPItemText* names_;
};

}  // namespace trimtab::views
