// SPDX-License-Identifier: GPL-3.0-or-later
#include "dock_layout.h"

#include <QDockWidget>
#include <QMainWindow>
#include <QScrollArea>
#include <QTabBar>
#include <algorithm>
#include <utility>

namespace trimtab::workbench {
namespace {

/// Editors stacked in one column would ask for more height than a small screen has.
QScrollArea* scrollable(QWidget* content) {
  auto* area = new QScrollArea;
  area->setFrameShape(QFrame::NoFrame);
  area->setWidgetResizable(true);
  area->setWidget(content);
  return area;
}

}  // namespace

void DockLayout::addDock(const char* name, const QString& title, Place place, QWidget* content) {
  auto* dock = new QDockWidget(title, &window_);
  dock->setObjectName(QLatin1String(name));
  dock->setWidget(place == Place::foot ? content : scrollable(content));
  window_.addDockWidget(place == Place::foot ? Qt::BottomDockWidgetArea : Qt::RightDockWidgetArea, dock);
  docks_.push_back({dock, place});
}

void DockLayout::arrange() {
  window_.setCorner(Qt::BottomRightCorner, Qt::RightDockWidgetArea);
  for (const Dock& each : docks_) {
    each.widget->setFloating(false);
    each.widget->show();
    // Qt cannot split a dock off while it is in a group of tabs.
    window_.removeDockWidget(each.widget);
  }
  const auto first = [this](Place place) {
    return std::find_if(docks_.begin(), docks_.end(), [place](const Dock& d) { return d.place == place; })
        ->widget;
  };
  QDockWidget *edit = first(Place::edit), *effect = first(Place::effect), *foot = first(Place::foot);
  window_.addDockWidget(Qt::RightDockWidgetArea, edit);
  window_.splitDockWidget(edit, effect, Qt::Vertical);
  window_.addDockWidget(Qt::BottomDockWidgetArea, foot);
  for (const auto& [front, place] :
       {std::pair{edit, Place::edit}, {effect, Place::effect}, {foot, Place::foot}}) {
    QDockWidget* last = front;
    for (const Dock& each : docks_) {
      if (each.place != place) continue;
      if (each.widget != front) window_.tabifyDockWidget(std::exchange(last, each.widget), each.widget);
      each.widget->show();
    }
    front->raise();
  }
  window_.resizeDocks({edit}, {570}, Qt::Horizontal);
  window_.resizeDocks({edit, effect}, {620, 330}, Qt::Vertical);
  window_.resizeDocks({foot}, {290}, Qt::Vertical);
}

void DockLayout::showFrame(const views::LiveFrame& frame) const {
  for (const auto& show : viewers_) show(frame);
}

void showWholeTitles(QTabBar& bar) {
  bar.setElideMode(Qt::ElideNone);
  bar.setUsesScrollButtons(true);
}

}  // namespace trimtab::workbench
