// SPDX-License-Identifier: GPL-3.0-or-later
#include "dock_layout.h"

#include <QDockWidget>
#include <QMainWindow>
#include <QTabBar>
#include <QTabWidget>
#include <algorithm>
#include <array>
#include <cmath>

#include "app/workbench/docks/dock_of.h"
#include "views/controls/scrollable.h"

namespace trimtab::workbench {
namespace {

Qt::DockWidgetArea areaOf(DockLayout::Place place) {
  return place == DockLayout::Place::foot ? Qt::BottomDockWidgetArea : Qt::RightDockWidgetArea;
}

}  // namespace

void DockLayout::addDock(const char* name, const QString& title, Place place, QWidget* content) {
  auto* dock = new QDockWidget(title, &window_);
  dock->setObjectName(QLatin1String(name));
  dock->setWidget(place == Place::foot ? content : views::scrollable(content, title));
  window_.addDockWidget(areaOf(place), dock);
  docks_.push_back({dock, place});
}

void DockLayout::addPage(const char* name, const QString& title, QWidget* content) {
  const auto dock = std::find_if(docks_.begin(), docks_.end(), [name](const Dock& each) {
    return each.widget->objectName() == QLatin1String(name);
  });
  auto* pages = qobject_cast<QTabWidget*>(dock->widget->widget());
  if (pages == nullptr) {
    QWidget* const first = dock->widget->widget();
    pages = new QTabWidget;
    pages->setDocumentMode(true);
    pages->setAccessibleName(dock->widget->windowTitle());
    dock->widget->setWidget(pages);
    pages->addTab(first, dock->widget->windowTitle());
  }
  pages->addTab(dock->place == Place::foot ? content : views::scrollable(content, title), title);
}

void DockLayout::setQuestion(const char* name, const QString& question) {
  find(name)->setToolTip(question);
}

QDockWidget* DockLayout::find(const char* name) const {
  const auto at = std::find_if(docks_.begin(), docks_.end(), [name](const Dock& dock) {
    return dock.widget->objectName() == QLatin1String(name);
  });
  return at == docks_.end() ? nullptr : at->widget;
}

void DockLayout::arrange(const Arrangement& wanted) {
  window_.setCorner(Qt::BottomRightCorner,
                    wanted.wideFoot ? Qt::BottomDockWidgetArea : Qt::RightDockWidgetArea);
  for (const Dock& each : docks_) {
    each.widget->setFloating(false);
    // Qt cannot split a dock off while it is in a group of tabs.
    window_.removeDockWidget(each.widget);
  }
  const QList<QDockWidget*> right = put(wanted.right, Qt::RightDockWidgetArea, Qt::Vertical),
                            foot = put(wanted.foot, Qt::BottomDockWidgetArea, Qt::Horizontal);
  hideAtHome();
  shares_.clear();
  const auto size = [&](const QList<QDockWidget*>& fronts, const std::vector<Arrangement::Group>& groups,
                        Qt::Orientation along, int lengthPx, double depth) {
    if (fronts.isEmpty()) return;
    QList<int> lengths;
    for (const Arrangement::Group& group : groups) lengths << static_cast<int>(group.share * lengthPx);
    window_.resizeDocks(fronts, lengths, along);
    shares_.push_back({fronts.first(), along == Qt::Vertical ? Qt::Horizontal : Qt::Vertical, depth});
    for (QDockWidget* front : fronts) front->raise();
  };
  size(right, wanted.right, Qt::Vertical, window_.height(), wanted.rightShare);
  size(foot, wanted.foot, Qt::Horizontal, window_.width(), wanted.footShare);
  keepShares();
}

void DockLayout::keepShares() {
  for (const Share& share : shares_) {
    if (share.dock->isHidden() || share.dock->isFloating()) continue;
    const int whole = share.along == Qt::Horizontal ? window_.width() : window_.height();
    window_.resizeDocks({share.dock}, {static_cast<int>(std::lround(share.share * whole))}, share.along);
  }
}

void DockLayout::noteShares(QSize window) {
  shares_.clear();
  for (const Dock& each : docks_) {
    if (!isInFront(*each.widget) || each.widget->isFloating()) continue;
    if (window_.dockWidgetArea(each.widget) == Qt::BottomDockWidgetArea)
      shares_.push_back({each.widget, Qt::Vertical, double(each.widget->height()) / window.height()});
    else
      shares_.push_back({each.widget, Qt::Horizontal, double(each.widget->width()) / window.width()});
  }
}

/// Returns the front dock of each group.
QList<QDockWidget*> DockLayout::put(const std::vector<Arrangement::Group>& groups, Qt::DockWidgetArea area,
                                    Qt::Orientation along) {
  QList<QDockWidget*> fronts;
  for (const Arrangement::Group& group : groups) {
    QDockWidget* const front = find(group.docks.front());
    if (fronts.isEmpty())
      window_.addDockWidget(area, front);
    else
      window_.splitDockWidget(fronts.last(), front, along);
    fronts << front;
  }
  for (std::size_t i = 0; i < groups.size(); ++i) {
    QDockWidget* last = fronts[qsizetype(i)];
    for (const char* name : groups[i].docks) {
      QDockWidget* const dock = find(name);
      if (dock != last) window_.tabifyDockWidget(last, dock);
      dock->show();
      last = dock;
    }
  }
  return fronts;
}

/// A hidden dock keeps its place among the tabs, so that it appears there when a person asks for it.
void DockLayout::hideAtHome() {
  std::array<QDockWidget*, 3> home{};
  for (const Dock& each : docks_)
    if (QDockWidget*& at = home[std::size_t(each.place)];
        at == nullptr && !each.widget->isHidden() &&
        window_.dockWidgetArea(each.widget) == areaOf(each.place))
      at = each.widget;
  for (const Dock& each : docks_) {
    if (!each.widget->isHidden()) continue;
    QDockWidget*& at = home[std::size_t(each.place)];
    if (at != nullptr) {
      window_.tabifyDockWidget(at, each.widget);
    } else {
      window_.addDockWidget(areaOf(each.place), each.widget);
      at = each.widget;
    }
    each.widget->hide();
  }
}

void DockLayout::arrangeAll() {
  Arrangement all{{{{}, 0.62}, {{}, 0.38}}, {{{}, 1}}, 0.41, 0.32, false};
  // The names are read here only, while the docks hold them.
  std::vector<QByteArray> names;
  for (const Dock& each : docks_) names.push_back(each.widget->objectName().toLatin1());
  for (std::size_t i = 0; i < docks_.size(); ++i) {
    Arrangement::Group& group = docks_[i].place == Place::foot   ? all.foot.front()
                                : docks_[i].place == Place::edit ? all.right.front()
                                                                 : all.right.back();
    group.docks.push_back(names[i].constData());
  }
  arrange(all);
}

void DockLayout::showFrame(const views::LiveFrame& frame) const {
  for (const auto& show : viewers_) show(frame);
}

void arrangeTabs(QTabBar& bar) {
  bar.setElideMode(Qt::ElideNone);
  bar.setUsesScrollButtons(true);
  bar.setAccessibleName(QObject::tr("Docks"));
}

}  // namespace trimtab::workbench
