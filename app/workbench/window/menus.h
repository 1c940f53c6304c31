// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QKeySequence>
#include <QList>
#include <QObject>
#include <QString>
#include <functional>
#include <initializer_list>

#include "app/workbench/controllers/workplace.h"
#include "panels.h"
#include "trimtab/frame/overlays.h"

class QAction;
class QMainWindow;
class QMenu;

namespace trimtab::workbench {

struct Controllers;
class SessionKeeper;

/// The window's commands. Each is written down once, in a table for its menu; toolbars, the docks' buttons,
/// shortcuts and the help on keys come from there.
class Menus : public QObject {
  Q_OBJECT

 public:
  Menus(QMainWindow& window, const Workplace& workplace, const Controllers& controllers, const Panels& panels,
        SessionKeeper& sessions);

  /// The menu that the workspaces fill.
  QMenu& workspaces() { return *workspaces_; }

 signals:
  void everyDockAsked();
  void importAsked();
  void welcomeAsked();

 private:
  /// One line of a menu. Without a text it is a separator.
  struct Command {
    QString text = {};
    QKeySequence keys = {};
    std::function<void()> run = {};
    QString toolTip = {};
    QAction** made = nullptr;  ///< receives the action, for a toolbar or a dock
  };
  void add(QMenu& menu, std::initializer_list<Command> commands);
  QAction* addOverlay(QMenu& view, const QString& text, const QString& keys, bool Overlays::*flag);
  bool eventFilter(QObject* watched, QEvent* event) override;
  void makeFileMenu();
  void makeEditMenu();
  void addSnapshots(QMenu& edit);
  void makeViewMenu();
  void makeFlightMenu();
  void makeHelpMenu();
  void addPresetMenus(QMenu& file);
  void addCases(QMenu& view);
  void addComparison(QMenu& view);
  void addDocks(QMenu& view);
  void fillRecentMenu(QMenu& recent);

  QMainWindow& window_;
  Workplace at_;
  const Controllers& by_;
  Panels panels_;
  SessionKeeper& sessions_;
  QMenu* workspaces_ = nullptr;
  QList<QAction*> terrainActions_;  ///< the File menu commands that the Terrain dock has as buttons
};

}  // namespace trimtab::workbench
