// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QObject>
#include <QString>
#include <optional>
#include <vector>

#include "app/workbench/controllers/saved_session.h"
#include "app/workbench/controllers/workplace.h"

class QMenu;

namespace trimtab::views {
class Snapshots;
}

namespace trimtab::workbench {

struct Controllers;
class Workspaces;

/// Saves what is open in the window as a session's file and opens it again, and keeps views of the free
/// camera to come back to. At the end of the program the session is kept for the next start.
class SessionKeeper : public QObject {
  Q_OBJECT

 public:
  SessionKeeper(const Workplace& workplace, const Controllers& controllers, Workspaces& workspaces,
                views::Snapshots& snapshots);

  /// Opens a session. Asks first whether unsaved edits may be lost. What cannot be opened is reported in the
  /// Messages dock, and the rest is opened. Returns false if the file is no session, or if the person
  /// cancels.
  bool open(const QString& file);
  bool saveTo(const QString& file);
  void askOpen();
  void askSave();
  /// The file that holds the session of the last time; it may not be there.
  static QString lastFile();
  void keepLast();

  SavedSession current() const;
  const std::vector<SavedView>& views() const { return views_; }
  /// Keeps the view that is shown now: the camera's, or the pilot's while a host or a flight moves it. A view
  /// of the same name is replaced.
  void keepView(const QString& name);
  void forgetView(std::size_t index);
  /// Puts the camera there; while a host or a flight moves the view, says how to detach it.
  void goToView(std::size_t index);

  /// Fills a menu with commands to keep, forget and go to views; it follows them from then on.
  void fillMenu(QMenu& menu);

 signals:
  void viewsChanged();

 private:
  void place(const SavedView& view);
  void restore(const std::vector<SavedSnapshot>& snapshots);
  void askViewName();
  void showViews(QMenu& menu);

  Workplace at_;
  const Controllers& by_;
  Workspaces& workspaces_;
  views::Snapshots& snapshots_;
  QString file_;  ///< that was opened or saved last; empty if none was
  std::vector<SavedView> views_;
  std::optional<SavedView> placeSoon_;  ///< once the session's terrain is open
};

}  // namespace trimtab::workbench
