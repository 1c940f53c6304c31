// SPDX-License-Identifier: GPL-3.0-or-later
#include <QDockWidget>
#include <QPushButton>
#include <QScrollArea>
#include <QTabBar>
#include <QUndoView>
#include <algorithm>
#include <utility>

#include "app/workbench/docks/error_dock.h"
#include "app/workbench/docks/experiments_dock.h"
#include "app/workbench/docks/flight_dock.h"
#include "app/workbench/docks/host_dock.h"
#include "main_window.h"
#include "views/controls/parameter_table.h"
#include "views/editors/bands_editor.h"
#include "views/editors/membership_editor.h"
#include "views/model/keys.h"
#include "views/panels/culling_panel.h"
#include "views/panels/decision_panel.h"
#include "views/panels/motion_panel.h"
#include "views/panels/plots_panel.h"
#include "views/panels/rules_panel.h"
#include "views/panels/static_lod_panel.h"
#include "views/panels/symbology_panel.h"
#include "views/panels/terrain_panel.h"
#include "views/panels/weather_panel.h"
#include "views/plots/surface_plot.h"

// Which docks there are and where they stand.
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

/// What an engineer edits stands at the upper right, what it does below it, the history of a run at the foot.
/// Docks of one place are tabs, the first one in front.
template <class Panel>
Panel* MainWindow::addDock(const char* name, const QString& title, DockPlace place, Panel* content) {
  auto* dock = new QDockWidget(title, this);
  dock->setObjectName(QLatin1String(name));
  dock->setWidget(place == DockPlace::foot ? static_cast<QWidget*>(content) : scrollable(content));
  addDockWidget(place == DockPlace::foot ? Qt::BottomDockWidgetArea : Qt::RightDockWidgetArea, dock);
  docks_.push_back({dock, place});
  if constexpr (requires(const views::LiveFrame& frame) { content->showFrame(frame); })
    liveDocks_.push_back([content](const views::LiveFrame& frame) { content->showFrame(frame); });
  return content;
}

void MainWindow::makeDocks() {
  auto* history = new QUndoView(&draft_.undoStack());
  history->setEmptyLabel(tr("as opened"));
  history->setAccessibleName(tr("History of edits"));

  using enum DockPlace;
  addDock("memberships", tr("Memberships"), edit, new views::MembershipEditor(draft_));
  bands_ = addDock("depth_map", tr("Depth map"), edit, new views::BandsEditor(draft_));
  culling_ = addDock("culling", tr("Culling"), edit, makeCullingPanel());
  addDock("rules", tr("Rules"), edit, new views::RulesPanel(draft_));
  terrainPanel_ = addDock("terrain", tr("Terrain"), edit, makeTerrainPanel());
  staticLod_ = addDock("static_lod", tr("Static LOD"), edit, new views::StaticLodPanel(draft_));
  auto* weather = addDock("weather", tr("Weather"), edit, new views::WeatherPanel(draft_));
  connect(weather, &views::WeatherPanel::calibrationAsked, this, &MainWindow::calibrateWeather);
  auto* symbology = addDock("symbology", tr("Symbology"), edit, new views::SymbologyPanel(draft_));
  viewport_->setSymbologyEditor(&symbologyEditor_);
  connect(symbology, &views::SymbologyPanel::placingChanged, this, [this](bool on) {
    symbologyEditor_.setActive(on);
    if (on) viewport_->setFocus();
  });
  connect(symbology, &views::SymbologyPanel::selected, &symbologyEditor_, [this](int symbol) {
    if (symbologyEditor_.active()) symbologyEditor_.select(symbol);
  });
  connect(&symbologyEditor_, &SymbologyEditor::selectionChanged, symbology,
          &views::SymbologyPanel::setSelected);
  connect(&symbologyEditor_, &SymbologyEditor::ended, symbology,
          [symbology] { symbology->placeButton().setChecked(false); });
  auto* parameters = addDock("preset", tr("Preset"), edit, new views::ParameterTable(draft_));
  connect(parameters, &views::ParameterTable::editorAsked, this, &MainWindow::raiseEditorOf);
  addDock("decision", tr("Decision"), effect, new views::DecisionPanel(draft_));
  addDock("surface", tr("Surface"), effect, new views::SurfacePlot(draft_));
  motion_ = addDock("motion", tr("Head motion"), effect, new views::MotionPanel(draft_));
  connectMotion();
  hostDock_ = addDock("host", tr("Host"), effect, new HostDock(feed_, draft_));
  flightDock_ = addDock("flight", tr("Flight"), effect, new FlightDock(feed_));
  plots_ = addDock("plots", tr("Plots"), foot, new views::PlotsPanel(draft_));
  culling_->showStages(plots_->buffer());
  messages_ = addDock("messages", tr("Messages"), foot, new MessagePanel);
  addDock("history", tr("History"), foot, history);
  experiments_ =
      addDock("experiments", tr("Experiments"), foot,
              new ExperimentsDock([this](const QString& folder) { return experimentInputs(folder); }));
  errors_ = addDock("errors", tr("Run time against error"), foot, makeErrorDock());
  connectErrors();
  connect(staticLod_, &views::StaticLodPanel::overlayChanged, this, [this](int depth, bool picture) {
    overlays_.treeDepth = depth;
    overlays_.treePicture = picture;
    viewport_->invalidate();
  });
  connectCulling();
}

void MainWindow::raiseEditorOf(const QString& key) {
  const std::string name = key.toStdString();
  QDockWidget* const editor = dock(name == views::key::kRules   ? QStringLiteral("rules")
                                   : name == views::key::kBands ? QStringLiteral("depth_map")
                                                                : QStringLiteral("memberships"));
  editor->show();
  editor->raise();
  editor->widget()->setFocus();
}

QDockWidget* MainWindow::dock(const QString& name) const {
  return findChild<QDockWidget*>(name);
}

void MainWindow::arrangeDocks() {
  setCorner(Qt::BottomRightCorner, Qt::RightDockWidgetArea);
  for (const Dock& each : docks_) {
    each.widget->setFloating(false);
    each.widget->show();
    // A dock that stands in a group of tabs cannot be split from.
    removeDockWidget(each.widget);
  }
  const auto firstAt = [this](DockPlace place) {
    return std::find_if(docks_.begin(), docks_.end(), [place](const Dock& d) { return d.place == place; })
        ->widget;
  };
  QDockWidget *edit = firstAt(DockPlace::edit), *effect = firstAt(DockPlace::effect),
              *foot = firstAt(DockPlace::foot);
  addDockWidget(Qt::RightDockWidgetArea, edit);
  splitDockWidget(edit, effect, Qt::Vertical);
  addDockWidget(Qt::BottomDockWidgetArea, foot);
  for (QDockWidget* before : {edit, effect, foot}) {
    QDockWidget* last = before;
    const DockPlace place = before == edit     ? DockPlace::edit
                            : before == effect ? DockPlace::effect
                                               : DockPlace::foot;
    for (const Dock& each : docks_) {
      if (each.place != place) continue;
      if (each.widget != before) tabifyDockWidget(std::exchange(last, each.widget), each.widget);
      each.widget->show();
    }
    before->raise();
  }
  resizeDocks({edit}, {570}, Qt::Horizontal);
  resizeDocks({edit, effect}, {560, 400}, Qt::Vertical);
  resizeDocks({foot}, {290}, Qt::Vertical);
  // Whole titles; where they do not fit there are arrows.
  for (QTabBar* bar : findChildren<QTabBar*>(QString(), Qt::FindDirectChildrenOnly)) {
    bar->setElideMode(Qt::ElideNone);
    bar->setUsesScrollButtons(true);
  }
}

}  // namespace trimtab::workbench
