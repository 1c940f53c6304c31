// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QWidget>
#include <array>

#include "views/model/snapshots.h"
#include "views/model/throttle.h"

class QGridLayout;
class QLabel;
class QLineEdit;
class QToolButton;

namespace trimtab::views {

/// Snapshot A is switched to with this function key, B and C with the next ones.
inline constexpr int kFirstSnapshotKey = 9;

/// The snapshots A, B and C, a line each: a button that switches to it, its name, what its images have cost
/// since the switch, and buttons that keep the draft there, pin it and forget it.
class SnapshotsPanel : public QWidget {
  Q_OBJECT
 public:
  SnapshotsPanel(Draft& draft, Snapshots& snapshots, QWidget* parent = nullptr);

  QToolButton& switchButton(int slot) { return *line(slot).go; }
  QToolButton& pinButton(int slot) { return *line(slot).pin; }
  QLineEdit& nameEdit(int slot) { return *line(slot).name; }
  QString resultText(int slot) const;

 private:
  struct Line {
    QToolButton *go = nullptr, *keep = nullptr, *pin = nullptr, *forget = nullptr;
    QLineEdit* name = nullptr;
    QLabel* result = nullptr;
  };
  Line& line(int slot) { return lines_[static_cast<std::size_t>(slot)]; }
  void makeLine(QGridLayout& grid, int slot);
  void refresh();
  void refreshResults();
  QString measuredText(int slot) const;

  Snapshots& snapshots_;
  std::array<Line, Snapshots::kCount> lines_;
  Throttle throttle_;
};

}  // namespace trimtab::views
