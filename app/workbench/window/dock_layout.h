// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QList>
#include <QString>
#include <functional>
#include <vector>

#include "views/model/live.h"

class QDockWidget;
class QMainWindow;
class QTabBar;
class QWidget;

namespace trimtab::workbench {

/// Where docks stand: groups of tabs on the right, from top to bottom, and at the foot, from left to right.
struct Arrangement {
  struct Group {
    std::vector<const char*> docks;  ///< object names; the first one is in front
    double share = 1;                ///< of the column's height or the foot's width
  };
  std::vector<Group> right, foot;
  double rightShare = 0.4, footShare = 0.35;  ///< of the window's width and height
  bool wideFoot = false;                      ///< the foot runs under the docks on the right
};

/// The docks of a window and where they stand. What an engineer edits is at home at the upper right, what it
/// does below that, and the history of a run at the foot. An arrangement shows some of them; the others wait
/// hidden where they are at home.
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
  /// Makes a content one more page of a dock, which shows its pages as tabs from then on.
  template <class Panel>
  Panel* join(const char* name, const QString& title, Panel* content) {
    addPage(name, title, content);
    if constexpr (requires(const views::LiveFrame& frame) { content->showFrame(frame); })
      viewers_.push_back([content](const views::LiveFrame& frame) { content->showFrame(frame); });
    return content;
  }
  /// Sets the question that a dock answers, as its tool tip.
  void setQuestion(const char* name, const QString& question);
  void arrange(const Arrangement& wanted);
  /// Shows every dock where it is at home, as tabs.
  void arrangeAll();
  /// Gives the column on the right and the foot their share of the window as it is now. Qt itself leaves what
  /// the window gains to the image.
  void keepShares();
  /// Takes the shares that they have of a window of this size as those to keep.
  void noteShares(QSize window);
  void showFrame(const views::LiveFrame& frame) const;

 private:
  struct Dock {
    QDockWidget* widget;
    Place place;
  };
  struct Share {
    QDockWidget* dock;
    Qt::Orientation along;
    double share;  ///< of the window's width or height
  };
  void addDock(const char* name, const QString& title, Place place, QWidget* content);
  void addPage(const char* name, const QString& title, QWidget* content);
  QDockWidget* find(const char* name) const;
  QList<QDockWidget*> put(const std::vector<Arrangement::Group>& groups, Qt::DockWidgetArea area,
                          Qt::Orientation along);
  void hideAtHome();

  QMainWindow& window_;
  std::vector<Dock> docks_;
  std::vector<Share> shares_;
  std::vector<std::function<void(const views::LiveFrame&)>> viewers_;
};

/// Shows the titles of docks that share a place whole, with arrows to those that do not fit, and names the
/// bar.
void arrangeTabs(QTabBar& bar);

}  // namespace trimtab::workbench
