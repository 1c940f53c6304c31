// SPDX-License-Identifier: GPL-3.0-or-later
#include "menus.h"

#include <QAction>
#include <QActionGroup>
#include <QApplication>
#include <QDockWidget>
#include <QFileInfo>
#include <QKeyEvent>
#include <QMainWindow>
#include <QMenu>
#include <QMenuBar>
#include <QStyle>
#include <QToolBar>
#include <QToolButton>

#include "app/workbench/controllers/controllers.h"
#include "app/workbench/controllers/recent_files.h"
#include "app/workbench/docks/changes_dock.h"
#include "app/workbench/docks/dock_of.h"
#include "app/workbench/docks/flight_dock.h"
#include "app/workbench/jobs/feed.h"
#include "app/workbench/viewport/split_view.h"
#include "app/workbench/viewport/viewport.h"
#include "appearance.h"
#include "help.h"
#include "palette.h"
#include "palette_entries.h"
#include "reference.h"
#include "session_keeper.h"
#include "trimtab/preset/preset.h"
#include "trimtab/preset/table.h"
#include "views/model/draft.h"
#include "views/model/theme.h"
#include "views/panels/culling_panel.h"
#include "views/panels/snapshots_panel.h"
#include "views/panels/terrain_panel.h"
#include "views/policy/policy_panel.h"
#include "views/policy/scheme_page.h"

namespace trimtab::workbench {
namespace {

constexpr auto kCaseKey = "culling.case";

/// Gives an action the short text and the icon that it has in a toolbar.
void dress(QAction& action, const QString& iconText, const QIcon& icon = {}) {
  action.setIconText(iconText);
  if (!icon.isNull()) action.setIcon(icon);
}

/// A tile has one colour only: either action switches the other off.
void makeExclusive(QAction* one, QAction* other) {
  const auto link = [](QAction* on, QAction* off) {
    QObject::connect(on, &QAction::toggled, off, [off](bool checked) {
      if (checked) off->setChecked(false);
    });
  };
  link(one, other);
  link(other, one);
}

}  // namespace

Menus::Menus(QMainWindow& window, const Workplace& workplace, const Controllers& controllers,
             const Panels& panels, SessionKeeper& sessions)
    : QObject(&window),
      window_(window),
      at_(workplace),
      by_(controllers),
      panels_(panels),
      sessions_(sessions) {
  makeFileMenu();
  makeEditMenu();
  makeViewMenu();
  makeFlightMenu();
  makeHelpMenu();
  qApp->installEventFilter(this);
}

/// Where a text is edited, X11 gives Ctrl+E and Ctrl+K to the cursor. Here they are commands everywhere.
bool Menus::eventFilter(QObject* watched, QEvent* event) {
  if (event->type() == QEvent::ShortcutOverride) {
    const auto& key = static_cast<const QKeyEvent&>(*event);
    if (key.modifiers() == Qt::ControlModifier && (key.key() == Qt::Key_E || key.key() == Qt::Key_K)) {
      event->ignore();
      return true;
    }
  }
  return QObject::eventFilter(watched, event);
}

void Menus::add(QMenu& menu, std::initializer_list<Command> commands) {
  for (const Command& command : commands) {
    if (command.text.isEmpty()) {
      menu.addSeparator();
      continue;
    }
    QAction* const action = menu.addAction(command.text);
    action->setShortcut(command.keys);
    if (!command.toolTip.isEmpty()) action->setToolTip(command.toolTip);
    if (command.run) connect(action, &QAction::triggered, this, command.run);
    if (command.made != nullptr) *command.made = action;
  }
}

void Menus::makeFileMenu() {
  QMenu& file = *window_.menuBar()->addMenu(tr("&File"));
  const auto icon = [this](QStyle::StandardPixmap which) { return window_.style()->standardIcon(which); };
  DocumentController& document = *by_.document;
  TerrainController& terrain = *by_.terrain;
  QAction *open = nullptr, *save = nullptr, *exporting = nullptr, *openTerrain = nullptr,
          *openFolder = nullptr, *bake = nullptr, *trace = nullptr;

  QMenu& fresh = *file.addMenu(icon(QStyle::SP_FileIcon), tr("&New preset"));
  for (const std::string_view name : shippedPresets())
    add(fresh, {{tr("from %1").arg(views::fromView(name)),
                 name == "default" ? QKeySequence(QKeySequence::New) : QKeySequence(),
                 [&document, name] { document.startFrom(views::fromView(name)); }}});
  add(file, {{tr("&Open preset..."), QKeySequence::Open, [&] { document.askOpen(); }, {}, &open}});
  addPresetMenus(file);
  add(file, {{tr("&Save preset"), QKeySequence::Save, [&] { document.save(); }, {}, &save},
             {tr("Save preset &as..."), tr("Ctrl+Shift+S"), [&] { document.saveAs(); }},
             {tr("Export a&gain"), tr("Ctrl+E"), [&] { document.exportAgain(); },
              tr("Exports to the last target of this preset without a question; asks if there is none"),
              &exporting},
             {tr("&Export for an image generator..."), tr("Ctrl+Shift+E"), [&] { document.askExport(); }},
             {tr("&Import..."),
              {},
              [this] { emit importAsked(); },
              tr("A policy, or whatever else this program can open")},
             {tr("Export poli&cy..."),
              {},
              [this] { panels_.policy->askAndExport(); },
              tr("Terms and rules that set the levers")},
             {}});
  by_.ig->fillMenu(*file.addMenu(tr("Ima&ge generator")));
  add(file, {{},
             {tr("Open &terrain..."), tr("Ctrl+T"), [&] { terrain.askOpenFile(); }, {}, &openTerrain},
             {tr("Open terrain &folder or database..."),
              tr("Ctrl+Shift+T"),
              [&] { terrain.askOpenFolder(); },
              {},
              &openFolder},
             {tr("&Bake a terrain database..."), tr("Ctrl+B"), [&] { terrain.askBake(); },
              tr("Turns elevation, scenery and imagery into one folder that opens at once"), &bake},
             {tr("Open sa&mple terrain"), {}, [&] { terrain.openSample(); }},
             {},
             {tr("Recor&d trace..."), tr("Ctrl+R"), [this] { by_.trace->askOrStop(); }, {}, &trace},
             {tr("Open measured resu&lts..."), {}, [this] { by_.errors->askOpenResults(); }},
             {},
             {tr("Open sess&ion..."),
              {},
              [this] { sessions_.askOpen(); },
              tr("Terrain, preset, flight, host, workspace and views that were saved together")},
             {tr("Sa&ve session as..."), {}, [this] { sessions_.askSave(); }},
             {},
             {tr("&Quit"), tr("Ctrl+Q"), [this] { window_.close(); }}});

  trace->setCheckable(true);
  connect(by_.trace.get(), &TraceController::recordingChanged, trace, &QAction::setChecked);
  dress(*open, tr("Open preset"), icon(QStyle::SP_DialogOpenButton));
  dress(*save, tr("Save"), icon(QStyle::SP_DialogSaveButton));
  dress(*exporting, tr("Export"), icon(QStyle::SP_ArrowUp));
  dress(*openTerrain, tr("Open terrain"), icon(QStyle::SP_DirOpenIcon));
  dress(*openFolder, tr("Open folder"));
  dress(*bake, tr("Bake..."));
  auto* bar = window_.addToolBar(tr("File"));
  bar->setObjectName(QStringLiteral("file_toolbar"));
  bar->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
  bar->addActions({open, save, exporting, openTerrain});
  terrainActions_ = {openTerrain, openFolder, bake};
}

void Menus::addPresetMenus(QMenu& file) {
  QMenu& shipped = *file.addMenu(tr("Open s&hipped preset"));
  shipped.setObjectName(QStringLiteral("shipped"));
  for (const std::string_view name : shippedPresets())
    add(shipped,
        {{views::fromView(name), {}, [this, name] { by_.document->openOverEdits(views::fromView(name)); }}});
  QMenu& recent = *file.addMenu(tr("&Recent"));
  recent.setObjectName(QStringLiteral("recent"));
  connect(&recent, &QMenu::aboutToShow, this, [this, &recent] { fillRecentMenu(recent); });
}

void Menus::fillRecentMenu(QMenu& recent) {
  recent.clear();
  const auto addKind = [this, &recent](const QString& kind, const QString& title,
                                       const std::function<void(const QString&)>& open) {
    const QStringList paths = recentFiles(kind);
    if (!paths.isEmpty()) recent.addSection(title);
    for (const QString& path : paths) {
      QAction* made = nullptr;
      add(recent, {{QFileInfo(path).fileName(), {}, [open, path] { open(path); }, path, &made}});
      made->setEnabled(QFileInfo::exists(path));
    }
  };
  addKind(QStringLiteral("preset"), tr("Presets"),
          [this](const QString& path) { by_.document->openOverEdits(path); });
  addKind(QStringLiteral("terrain"), tr("Terrain"), [this](const QString& path) { by_.terrain->open(path); });
  addKind(QStringLiteral("flight"), tr("Flights"), [this](const QString& path) { by_.flight->open(path); });
  addKind(QStringLiteral("session"), tr("Sessions"), [this](const QString& path) { sessions_.open(path); });
  if (recent.isEmpty()) recent.addAction(tr("nothing yet"))->setEnabled(false);
  recent.setToolTipsVisible(true);
}

void Menus::makeEditMenu() {
  QMenu& edit = *window_.menuBar()->addMenu(tr("&Edit"));
  const auto icon = [this](QStyle::StandardPixmap which) { return window_.style()->standardIcon(which); };
  QAction* undo = at_.draft.undoStack().createUndoAction(&window_, tr("&Undo"));
  undo->setShortcut(QKeySequence::Undo);
  dress(*undo, tr("Undo"), icon(QStyle::SP_ArrowBack));
  QAction* redo = at_.draft.undoStack().createRedoAction(&window_, tr("&Redo"));
  redo->setShortcuts({tr("Ctrl+Shift+Z"), tr("Ctrl+Y")});
  dress(*redo, tr("Redo"), icon(QStyle::SP_ArrowForward));
  edit.addActions({undo, redo});
  auto* const palette =
      new Palette([this] { return paletteEntries(window_, by_, panels_, sessions_); }, &window_);
  add(edit, {{}, {tr("&Find anything..."), tr("Ctrl+K"), [palette] { palette->begin(); }}});
  add(edit, {{},
             {tr("Reset &all parameters to the file"),
              {},
              [this] { at_.draft.resetAll(views::Reference::file); },
              tr("Back to the values of the preset as it was opened or saved last")},
             {tr("Reset all parameters to the &base"),
              {},
              [this] { at_.draft.resetAll(views::Reference::base); },
              tr("Back to the values of the preset that the file names as its base")},
             {tr("Reset all parameters to the &defaults"), {}, [this] {
                at_.draft.resetAll(views::Reference::defaults);
              }}});
  addSnapshots(edit);
  auto* bar = window_.addToolBar(tr("Edit"));
  bar->setObjectName(QStringLiteral("edit_toolbar"));
  // The actions' texts name the step that they undo, so buttons of their own keep the toolbar's width.
  for (QAction* action : {undo, redo}) {
    auto* button = new QAction(action->icon(), action->iconText(), &window_);
    button->setEnabled(action->isEnabled());
    connect(action, &QAction::enabledChanged, button, &QAction::setEnabled);
    connect(action, &QAction::changed, button, [button, action] { button->setToolTip(action->toolTip()); });
    connect(button, &QAction::triggered, action, &QAction::trigger);
    bar->addAction(button);
  }
}

void Menus::addSnapshots(QMenu& edit) {
  QMenu& menu = *edit.addMenu(tr("&Snapshots"));
  views::Snapshots& snapshots = panels_.changes->snapshots();
  for (int slot = 0; slot < views::Snapshots::kCount; ++slot) {
    const QString letter = snapshots.title(slot);
    const int key = Qt::Key_F1 + views::kFirstSnapshotKey - 1 + slot;
    add(menu,
        {{tr("Switch to snapshot &%1").arg(letter), QKeySequence(key),
          [&snapshots, slot] { snapshots.switchTo(slot); }, tr("An empty one keeps the preset as it is now")},
         {tr("Keep as snapshot %1").arg(letter), QKeySequence(int(Qt::ShiftModifier) | key),
          [&snapshots, slot] { snapshots.keep(slot); }}});
  }
}

QAction* Menus::addOverlay(QMenu& view, const QString& text, const QString& keys, bool Overlays::*flag) {
  QAction* action = nullptr;
  add(view, {{text, keys, {}, {}, &action}});
  action->setCheckable(true);
  connect(action, &QAction::toggled, this, [this, flag](bool on) { by_.culling->setOverlay(flag, on); });
  return action;
}

void Menus::makeViewMenu() {
  QMenu& view = *window_.menuBar()->addMenu(tr("&View"));
  QAction* wireframe = addOverlay(view, tr("&Wireframe"), tr("Ctrl+Shift+1"), &Overlays::wireframe);
  QAction* bounds = addOverlay(view, tr("Tile &bounds"), tr("Ctrl+Shift+2"), &Overlays::tileBounds);
  QAction* byReason =
      addOverlay(view, tr("Colour by &reason"), tr("Ctrl+Shift+3"), &Overlays::colourByReason);
  QAction* byLevel = addOverlay(view, tr("Colour by &level"), tr("Ctrl+Shift+4"), &Overlays::colourByLevel);
  QAction* voids = addOverlay(view, tr("Filled &voids"), tr("Ctrl+Shift+5"), &Overlays::voids);
  voids->setToolTip(tr("Highlights posts that the sources leave open; visible where patches are drawn"));
  QAction* squares = addOverlay(view, tr("Te&xture squares"), tr("Ctrl+Shift+6"), &Overlays::textureSquares);
  squares->setToolTip(tr(
      "Draws static trees with squares of an eighth of a texture, so that one sees how textures lie on each\n"
      "level; needs a terrain baked from scenery with --keep-texture"));
  makeExclusive(byReason, byLevel);
  QAction *freeze = nullptr, *detach = nullptr;
  add(view,
      {{tr("&Freeze culling"),
        tr("Ctrl+F"),
        {},
        tr("Decision, levels and visible set stay as they are now; keys and mouse fly the view"),
        &freeze},
       {tr("D&etach from the pilot's eye"),
        tr("Ctrl+Shift+F"),
        {},
        tr("The pilot's eye goes on deciding and culling; keys and mouse fly a second eye that looks at it"),
        &detach}});
  freeze->setCheckable(true);
  detach->setCheckable(true);
  dress(*detach, tr("Detach"));
  ObserverController* const observer = by_.observer.get();
  connect(freeze, &QAction::toggled, observer, &ObserverController::setFrozen);
  connect(observer, &ObserverController::frozenChanged, freeze, &QAction::setChecked);
  connect(detach, &QAction::toggled, observer, &ObserverController::setDetached);
  connect(observer, &ObserverController::detachedChanged, detach, &QAction::setChecked);
  // Where somebody looks at culling from outside, the colours are what there is to see.
  connect(observer, &ObserverController::detachedChanged, byReason,
          [byReason, byLevel, ours = false](bool on) mutable {
            const bool wanted = on && !byLevel->isChecked() && !byReason->isChecked();
            if (wanted || (!on && ours)) byReason->setChecked(on);
            ours = on && (ours || wanted);
          });
  view.addSeparator();
  addCases(view);
  add(view, {{tr("&Place the camera over the terrain"), Qt::Key_Home, [this] {
                if (at_.viewport.cameraEnabled()) by_.flight->placeCamera();
              }}});
  sessions_.fillMenu(*view.addMenu(tr("Kept v&iews")));
  QAction* fills = nullptr;
  add(view,
      {{tr("F&ill the viewport"),
        {},
        {},
        tr("On: the image fills its place, and its field of view grows beyond the preset's at two sides\n"
           "Off: the field of view is the preset's, with bars where the viewport has another shape"),
        &fills},
       {}});
  fills->setCheckable(true);
  fills->setChecked(by_.frame->fills());
  connect(fills, &QAction::toggled, by_.frame.get(), &FrameController::setFills);
  addComparison(view);
  addDocks(view);
  workspaces_ = view.addMenu(tr("Wor&kspaces"));
  addAppearances(*view.addMenu(tr("C&olours")));
  auto* bar = window_.addToolBar(tr("View"));
  bar->setObjectName(QStringLiteral("view_toolbar"));
  bar->setToolButtonStyle(Qt::ToolButtonTextOnly);
  auto* colours = new QToolButton(bar);
  colours->setText(tr("Overlays"));
  colours->setToolTip(tr("Colours and lines over the image"));
  colours->setPopupMode(QToolButton::InstantPopup);
  colours->addActions({wireframe, bounds, byReason, byLevel, voids, squares});
  bar->addWidget(colours);
  bar->addActions({freeze, detach});
  panels_.terrain->setActions(terrainActions_, {byLevel, wireframe, voids});
  panels_.culling->setActions({byReason, bounds, freeze, detach});
}

void Menus::addComparison(QMenu& view) {
  SplitView& split = by_.errors->splitView();
  QMenu& menu = *view.addMenu(tr("Compare &two presets"));
  QAction* over = nullptr;
  add(menu, {{tr("In the &viewport"),
              tr("Ctrl+Shift+D"),
              {},
              tr("Both presets draw the image that is shown"),
              &over},
             {tr("&Flicker between both"), Qt::Key_F8, [&split] { split.flicker(); }},
             {tr("&Differences"), Qt::Key_F7, [&split] { split.toggleDifference(); }}});
  over->setCheckable(true);
  connect(over, &QAction::triggered, &split, [this](bool on) {
    if (on) return by_.errors->compare();
    by_.errors->endComparison();
  });
  connect(&split, &SplitView::overViewportChanged, over, &QAction::setChecked);
}

void Menus::addCases(QMenu& view) {
  QMenu& cases = *view.addMenu(tr("&Culling case"));
  const ParameterRow* const row = findRow(kCaseKey);
  if (row == nullptr) return;
  auto* group = new QActionGroup(this);
  for (std::size_t i = 0; i < row->choices.size(); ++i) {
    QAction* action = nullptr;
    add(cases, {{views::fromView(row->choices[i].label),
                 tr("Ctrl+Alt+%1").arg(i + 1),
                 [this, i] { at_.draft.setValue(kCaseKey, ChoiceIndex{i}); },
                 {},
                 &action}});
    action->setCheckable(true);
    group->addAction(action);
  }
  const auto showCase = [this, group] {
    const ParameterValue value = at_.draft.value(kCaseKey);
    const auto* choice = std::get_if<ChoiceIndex>(&value);
    const QList<QAction*> actions = group->actions();
    if (choice != nullptr && choice->index < std::size_t(actions.size()))
      actions[qsizetype(choice->index)]->setChecked(true);
  };
  connect(&at_.draft, &views::Draft::valueChanged, this, [showCase](const QString& key) {
    if (key == QLatin1String(kCaseKey)) showCase();
  });
  showCase();
}

void Menus::addDocks(QMenu& view) {
  QMenu& docks = *view.addMenu(tr("&Docks"));
  docks.setObjectName(QStringLiteral("docks"));
  int number = 1;
  for (QDockWidget* each : window_.findChildren<QDockWidget*>(QString(), Qt::FindDirectChildrenOnly)) {
    QAction* go = nullptr;
    const QKeySequence key(number <= 9 ? tr("Alt+%1").arg(number) : QString());
    ++number;
    add(docks, {{each->windowTitle(), key, [each] { goToOrClose(*each); },
                 tr("Goes to the dock; from inside the dock it closes it"), &go}});
    go->setCheckable(true);
    go->setChecked(!each->isHidden());
    // A click toggles the mark by itself; what the dock does decides.
    connect(go, &QAction::triggered, each, [each, go] { go->setChecked(!each->isHidden()); });
    // While a layout is put in place, Qt shows docks that it hides again.
    connect(&docks, &QMenu::aboutToShow, each, [each, go] { go->setChecked(!each->isHidden()); });
  }
  add(docks, {{}, {tr("Show &every dock"), {}, [this] { emit everyDockAsked(); }}});
}

void Menus::makeFlightMenu() {
  FlightController& flight = *by_.flight;
  add(*window_.menuBar()->addMenu(tr("F&light")),
      {{tr("&Open flight..."), tr("Ctrl+L"), [&] { flight.askOpen(); }},
       {tr("C&lose flight"), {}, [&] { flight.flightDock().close(); }},
       {tr("&Play or pause"), Qt::Key_F5, [&] { flight.playOrPause(); }},
       {tr("&Back to the start"), tr("Shift+F5"), [&] { flight.flightDock().stop(); }},
       {tr("&Measure presets along it..."), tr("Ctrl+M"), [this] { by_.errors->askAndMeasure(); }},
       {},
       {tr("&Connect or disconnect the host"), Qt::Key_F6, [&] { flight.connectOrDisconnectHost(); }}});
}

void Menus::makeHelpMenu() {
  auto* const reference = new Reference(&window_);
  add(*window_.menuBar()->addMenu(tr("&Help")),
      {{tr("&What is this control?"), QKeySequence::HelpContents,
        [this, reference] {
          if (!reference->explain(QApplication::focusWidget())) showKeys(&window_, *window_.menuBar());
        },
        tr("Shows the entry of the control that has the focus")},
       {tr("&Keys and mouse"), tr("Ctrl+F1"), [this] { showKeys(&window_, *window_.menuBar()); }},
       {tr("&Parameter reference"), tr("Shift+F1"), [reference] { reference->look({}); }},
       {tr("W&elcome page"), {}, [this] { emit welcomeAsked(); }},
       {},
       {tr("&About Trimtab"), {}, [this] { showAbout(&window_, at_.viewport.gl()); }}});
}

}  // namespace trimtab::workbench
