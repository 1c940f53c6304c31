// SPDX-License-Identifier: GPL-3.0-or-later
#include "panels.h"

#include <QDockWidget>
#include <QObject>

#include "app/workbench/controllers/controllers.h"
#include "app/workbench/docks/changes_dock.h"
#include "app/workbench/docks/dock_of.h"
#include "app/workbench/docks/fit_page.h"
#include "app/workbench/docks/flight_dock.h"
#include "app/workbench/docks/host_dock.h"
#include "app/workbench/docks/leverage_page.h"
#include "app/workbench/docks/message_panel.h"
#include "app/workbench/docks/search_page.h"
#include "app/workbench/jobs/view_pause.h"
#include "dock_layout.h"
#include "trimtab/preset/preset.h"
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
                       goTo(*dockOf(bands));
                       return;
                     }
                     raiseDock(policy);
                     policy.showEditorOf(name);
                   });
}

/// Gives each dock the one question that it answers.
void askQuestions(DockLayout& docks) {
  constexpr std::pair<const char*, const char*> kQuestions[] = {
      {"policy", QT_TRANSLATE_NOOP("QObject", "Which rules set the levers, and what is each lever worth?")},
      {"culling", QT_TRANSLATE_NOOP("QObject", "What is not drawn in this frame, and why?")},
      {"terrain",
       QT_TRANSLATE_NOOP("QObject", "What is the ground made of, and at which levels is it drawn?")},
      {"weather",
       QT_TRANSLATE_NOOP("QObject", "What does the weather add, and what does it allow to leave out?")},
      {"preset", QT_TRANSLATE_NOOP("QObject", "What is the value of each parameter, and what was changed?")},
      {"decision", QT_TRANSLATE_NOOP("QObject", "What was decided for this frame, and why?")},
      {"budget",
       QT_TRANSLATE_NOOP("QObject", "Is the frame within its budget, and what is given up for that?")},
      {"host", QT_TRANSLATE_NOOP("QObject", "Does the host send what the image needs?")},
      {"flight", QT_TRANSLATE_NOOP("QObject", "Where does the aircraft fly, and where does the pilot look?")},
      {"plots", QT_TRANSLATE_NOOP("QObject", "When did something change?")},
      {"messages", QT_TRANSLATE_NOOP("QObject", "What went wrong?")}};
  for (const auto& [name, question] : kQuestions) docks.setQuestion(name, QObject::tr(question));
}

}  // namespace

Panels makePanels(DockLayout& docks, views::Draft& draft, Feed& feed) {
  using enum DockLayout::Place;
  const auto tr = [](const char* text) { return QObject::tr(text); };
  Panels panels;
  panels.policy = docks.add("policy", tr("Policy"), edit, new views::PolicyPanel(draft));
  panels.culling = docks.add("culling", tr("Culling"), edit, new views::CullingPanel(draft));
  panels.bands = docks.join("culling", tr("Depth map"), new views::BandsEditor(draft));
  panels.terrain = docks.add("terrain", tr("Terrain"), edit, new views::TerrainPanel(draft));
  panels.staticLod = docks.join("terrain", tr("Static LOD"), new views::StaticLodPanel(draft));
  panels.weather = docks.add("weather", tr("Weather"), edit, new views::WeatherPanel(draft));
  panels.parameters = docks.add("preset", tr("Preset"), edit, new views::ParameterTable(draft));
  auto* const decision = docks.add("decision", tr("Decision"), effect, new views::DecisionPanel(draft));
  panels.budget = docks.add("budget", tr("Budget"), effect, new views::BudgetPanel(draft));
  panels.host = docks.add("host", tr("Host"), effect, new HostDock(feed, draft));
  panels.flight = docks.add("flight", tr("Flight"), effect, new FlightDock(feed));
  panels.motion = docks.join("flight", tr("Head motion"), new views::MotionPanel(draft));
  panels.symbology = docks.join("flight", tr("Symbology"), new views::SymbologyPanel(draft));
  QObject::connect(panels.budget, &views::BudgetPanel::replayAsked, panels.flight, &FlightDock::fly);
  panels.plots = docks.add("plots", tr("Plots"), foot, new views::PlotsPanel(draft));
  panels.messages = docks.add("messages", tr("Messages"), foot, new MessagePanel);
  panels.changes = docks.join("preset", tr("Changes"), new ChangesDock(draft));
  askQuestions(docks);
  panels.culling->showStages(panels.plots->buffer());
  connectEditors(*panels.parameters, *panels.policy, *panels.bands);
  QObject::connect(decision, &views::DecisionPanel::cullingAsked, panels.culling, [culling = panels.culling] {
    raiseDock(*culling);
    goTo(*dockOf(*culling));
  });
  return panels;
}

void addRunPages(DockLayout& docks, Panels& panels, const Controllers& by, views::Draft& draft,
                 ViewPause& pause) {
  const RunInputs& inputs = *by.inputs;
  const auto source = [&inputs](const QString& folder) { return inputs.write(folder); };
  panels.leverage = docks.join("policy", QObject::tr("Leverage"), new LeveragePage(source));
  panels.search = docks.join("errors", QObject::tr("Find"), new SearchPage(source));
  panels.fit =
      docks.join("errors", QObject::tr("Fit"),
                 new FitPage(draft, [&inputs](const QString& folder) { return inputs.writeForFit(folder); }));
  MessagePanel* const messages = panels.messages;
  pause.follow(panels.leverage->child(), &ChildRun::workingChanged, QObject::tr("leverage is measured"));
  pause.follow(panels.search->child(), &ChildRun::workingChanged, QObject::tr("presets are searched"));
  pause.follow(panels.fit->child(), &ChildRun::workingChanged, QObject::tr("an image generator is fitted"));
  QObject::connect(panels.fit, &FitPage::refused, messages, &MessagePanel::add);
  QObject::connect(panels.fit, &FitPage::chosen, by.ig.get(), &IgController::take);
  QObject::connect(panels.fit, &FitPage::profileAsked, by.ig.get(), &IgController::askOpen);
  QObject::connect(by.ig.get(), &IgController::fitAsked, panels.fit, [fit = panels.fit] {
    raiseDock(*fit);
    fit->begin();
  });
  QObject::connect(panels.leverage, &LeveragePage::refused, messages, &MessagePanel::add);
  QObject::connect(panels.search, &SearchPage::refused, messages, &MessagePanel::add);
  QObject::connect(panels.search, &SearchPage::comparisonAsked, by.errors.get(),
                   &ErrorsController::compareWith);
  QObject::connect(panels.search, &SearchPage::chosen, messages,
                   [&draft, messages](const QString& name, const QString& text) {
                     const Result<Preset> preset = parsePreset(text.toStdString(), name.toStdString());
                     if (!preset)
                       return messages->add(QObject::tr("The preset cannot be used"), preset.findings());
                     draft.takeParameters(preset->parameters, QObject::tr("Use %1").arg(name));
                   });
}

}  // namespace trimtab::workbench
