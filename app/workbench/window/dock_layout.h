// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QString>
#include <functional>
#include <vector>

#include "views/model/live.h"

class QDockWidget;
class QMainWindow;
class QTabBar;
class QWidget;

namespace trimtab::workbench {

/// The docks of a window and where they stand: what an engineer edits at the upper right, what it does below
/// that, and the history of a run at the foot. Docks of one place are tabs, the first one in front.
class DockLayout {
 public:
  enum class Place { edit, effect, foot };

  explicit DockLayout(QMainWindow& window) : window_(window) {}

  /// Makes a dock and returns its content. `name` is the dock's object name, under which layouts are saved.
  /// A content that has `showFrame` is shown every frame.
  template <class Panel>
  Panel* add(const char* name, const QString& title, Place place, Panel* content) {
    addDock(name, title, place, content);
    if constexpr (requires(const views::LiveFrame& frame) { content->showFrame(frame); })
      viewers_.push_back([content](const views::LiveFrame& frame) { content->showFrame(frame); });
    return content;
  }
  /// Puts every dock back to where it stands in a new window.
  void arrange();
  void showFrame(const views::LiveFrame& frame) const;

 private:
  struct Dock {
    QDockWidget* widget;
    Place place;
  };
  void addDock(const char* name, const QString& title, Place place, QWidget* content);

  QMainWindow& window_;
  std::vector<Dock> docks_;
  std::vector<std::function<void(const views::LiveFrame&)>> viewers_;
};

/// Titles of tabs are shown whole; arrows scroll to those that do not fit.
void showWholeTitles(QTabBar& bar);

}  // namespace trimtab::workbench
