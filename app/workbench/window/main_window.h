// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QMainWindow>

#include "app/workbench/controllers/controllers.h"
#include "app/workbench/jobs/draw_thread.h"
#include "app/workbench/jobs/feed.h"
#include "app/workbench/jobs/view_pause.h"
#include "app/workbench/viewport/viewport.h"
#include "dock_layout.h"
#include "options.h"
#include "panels.h"
#include "views/model/draft.h"

namespace trimtab::views {
class BudgetStrip;
}  // namespace trimtab::views

namespace trimtab::workbench {

class MessagePanel;
class NoticeBar;
class SessionKeeper;
class Workspaces;

/// The workbench's window: the viewport in the middle, docks around it, menus above. It makes the parts and
/// owns them; the controllers do the work.
class MainWindow : public QMainWindow {
  Q_OBJECT

 public:
  MainWindow();
  ~MainWindow() override;

  /// Shows the window and does what the command line asks for.
  void start(const Options& options);
  /// Keeps a copy of unsaved edits and completes a trace. For an end of the program that asks no questions.
  void keepUnsavedEdits();
  /// Opens whatever a file or folder is (fileKindOf).
  void openAny(const QString& path);
  /// Shows every dock where it is at home, as tabs.
  void showEveryDock() { docks_.arrangeAll(); }

  views::Draft& draft() { return draft_; }
  Feed& feed() { return feed_; }
  Viewport& viewport() { return *viewport_; }
  MessagePanel& messages() { return *panels_.messages; }
  NoticeBar& notices() { return *notices_; }
  views::BudgetStrip& strip() { return *strip_; }
  Workspaces& workspaces() { return *workspaces_; }
  SessionKeeper& sessions() { return *sessions_; }
  const Panels& panels() const { return panels_; }
  const Controllers& controllers() const { return controllers_; }
  /// Returns the dock with this object name; null if there is none.
  QDockWidget* dock(const QString& name) const { return findChild<QDockWidget*>(name); }

 protected:
  void closeEvent(QCloseEvent* event) override;
  void dragEnterEvent(QDragEnterEvent* event) override;
  void dropEvent(QDropEvent* event) override;
  bool event(QEvent* event) override;
  void childEvent(QChildEvent* event) override;

 private:
  void makeMiddle();
  void makeControllers();
  void makeMenus();
  void makeStatusBar();
  void connectPause();
  void showPause();
  void welcome();
  void askImport();
  void connectParts();
  void restoreSize();
  void showPlotsOf(int workspace);
  void keepPlots() const;
  void updateTitle();
  void takeScreenshotSoon();
  void takeScreenshot();

  // The parts that the members below refer to come first: they are destroyed last.
  views::Draft draft_;
  Feed feed_{draft_.active()};
  DrawThread measuring_;
  ViewPause pause_;
  Viewport* viewport_ = nullptr;
  NoticeBar* notices_ = nullptr;
  views::BudgetStrip* strip_ = nullptr;
  Workspaces* workspaces_ = nullptr;
  SessionKeeper* sessions_ = nullptr;
  DockLayout docks_{*this};
  Panels panels_;
  Controllers controllers_;
  Options options_;
  QString plotsOf_;  ///< the workspace whose plots are shown; empty at first
  bool screenshotDue_ = false;
};

}  // namespace trimtab::workbench
