// SPDX-License-Identifier: GPL-3.0-or-later
#include "panels.h"

#include <QDockWidget>
#include <QObject>

#include "app/workbench/docks/changes_dock.h"
#include "app/workbench/docks/dock_of.h"
#include "app/workbench/docks/flight_dock.h"
#include "app/workbench/docks/host_dock.h"
#include "app/workbench/docks/message_panel.h"
#include "dock_layout.h"
#include "views/controls/parameter_table.h"
#include "views/editors/bands_editor.h"
#include "views/model/draft.h"
#include "views/model/keys.h"
#include "views/panels/budget_panel.h"
#include "views/panels/culling_panel.h"
#include "views/panels/decision_panel.h"
#include "views/panels/motion_panel.h"
#include "views/panels/plots_panel.h"
#include "views/panels/static_lod_panel.h"
#include "views/panels/symbology_panel.h"
#include "views/panels/terrain_panel.h"
#include "views/panels/weather_panel.h"
#include "views/policy/policy_panel.h"

namespace trimtab::workbench {
namespace {

/// Some parameters have an editor of their own in another dock.
void connectEditors(const views::ParameterTable& parameters, views::PolicyPanel& policy,
                    const QWidget& bands) {
  QObject::connect(&parameters, &views::ParameterTable::editorAsked, &parameters,
                   [&policy, &bands](const QString& key) {
                     const std::string name = key.toStdString();
                     if (name == views::key::kBands) {
                       raiseDock(bands);
                       dockOf(bands)->widget()->setFocus();
                       return;
                     }
                     raiseDock(policy);
                     policy.showEditorOf(name);
                   });
}

}  // namespace

Panels makePanels(DockLayout& docks, views::Draft& draft, Feed& feed) {
  using enum DockLayout::Place;
  const auto tr = [](const char* text) { return QObject::tr(text); };
  Panels panels;
  panels.policy = docks.add("policy", tr("Policy"), edit, new views::PolicyPanel(draft));
  panels.bands = docks.add("depth_map", tr("Depth map"), edit, new views::BandsEditor(draft));
  panels.culling = docks.add("culling", tr("Culling"), edit, new views::CullingPanel(draft));
  panels.terrain = docks.add("terrain", tr("Terrain"), edit, new views::TerrainPanel(draft));
  panels.staticLod = docks.add("static_lod", tr("Static LOD"), edit, new views::StaticLodPanel(draft));
  panels.weather = docks.add("weather", tr("Weather"), edit, new views::WeatherPanel(draft));
  panels.symbology = docks.add("symbology", tr("Symbology"), edit, new views::SymbologyPanel(draft));
  panels.parameters = docks.add("preset", tr("Preset"), edit, new views::ParameterTable(draft));
  auto* const decision = docks.add("decision", tr("Decision"), effect, new views::DecisionPanel(draft));
  panels.budget = docks.add("budget", tr("Budget"), effect, new views::BudgetPanel(draft));
  panels.motion = docks.add("motion", tr("Head motion"), effect, new views::MotionPanel(draft));
  panels.host = docks.add("host", tr("Host"), effect, new HostDock(feed, draft));
  panels.flight = docks.add("flight", tr("Flight"), effect, new FlightDock(feed));
  QObject::connect(panels.budget, &views::BudgetPanel::replayAsked, panels.flight, &FlightDock::fly);
  panels.plots = docks.add("plots", tr("Plots"), foot, new views::PlotsPanel(draft));
  panels.messages = docks.add("messages", tr("Messages"), foot, new MessagePanel);
  panels.changes = docks.add("history", tr("Changes"), foot, new ChangesDock(draft));
  panels.culling->showStages(panels.plots->buffer());
  connectEditors(*panels.parameters, *panels.policy, *panels.bands);
  const auto toCulling = [culling = panels.culling] { goTo(*dockOf(*culling)); };
  QObject::connect(panels.bands, &views::BandsEditor::cullingAsked, panels.culling, toCulling);
  QObject::connect(decision, &views::DecisionPanel::cullingAsked, panels.culling, toCulling);
  return panels;
}

}  // namespace trimtab::workbench
