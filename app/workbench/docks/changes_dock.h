// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QSplitter>

#include "views/model/live.h"
#include "views/model/snapshots.h"

namespace trimtab::views {
class ChangesPanel;
class SnapshotsPanel;
}  // namespace trimtab::views

namespace trimtab::workbench {

/// What was changed, and snapshots to go back to: the list of changes beside the snapshots A, B and C.
class ChangesDock : public QSplitter {
  Q_OBJECT

 public:
  explicit ChangesDock(views::Draft& draft, QWidget* parent = nullptr);

  views::Snapshots& snapshots() { return snapshots_; }
  views::ChangesPanel& changes() { return *changes_; }
  void showFrame(const views::LiveFrame& frame) { snapshots_.showFrame(frame); }
  /// Sets whether a person can see it. It cannot find out itself, because Qt calls a dock behind other tabs
  /// visible.
  void setSeen(bool seen);

 signals:
  /// A person sees the results of a snapshot that is active: errors of live images are of use.
  void errorsWanted(bool wanted);

 private:
  void announce();

  views::Snapshots snapshots_;
  views::ChangesPanel* changes_;
  views::SnapshotsPanel* panel_;
  bool seen_ = false;
};

}  // namespace trimtab::workbench
