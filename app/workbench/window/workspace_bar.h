// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QToolBar>

class QActionGroup;
class QMenu;
class QWidget;

namespace trimtab::workbench {

class MessagePanel;
class Workspaces;

/// The workspaces as buttons, with Ctrl+1 to Ctrl+9, and a menu that saves, resets and exchanges them.
class WorkspaceBar : public QToolBar {
  Q_OBJECT

 public:
  /// Fills `menu` with the same commands.
  WorkspaceBar(Workspaces& workspaces, QMenu& menu, MessagePanel& messages, QWidget* parent);

 private:
  void makeMenu();
  void showList();
  void showCurrent(int index);
  void askSave();
  void askExport();
  void askImport();

  Workspaces& workspaces_;
  QMenu& menu_;
  MessagePanel& messages_;
  QActionGroup* group_;
  QAction *firstCommand_, *remove_;
};

}  // namespace trimtab::workbench
