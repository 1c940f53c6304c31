// SPDX-License-Identifier: GPL-3.0-or-later
#include <QAction>
#include <QActionGroup>
#include <QApplication>
#include <QDialog>
#include <QDialogButtonBox>
#include <QDockWidget>
#include <QFileInfo>
#include <QMenu>
#include <QMenuBar>
#include <QMessageBox>
#include <QSettings>
#include <QStyle>
#include <QTextBrowser>
#include <QToolBar>
#include <QVBoxLayout>

#include "app/workbench/docks/error_dock.h"
#include "app/workbench/docks/flight_dock.h"
#include "app/workbench/docks/host_dock.h"
#include "main_window.h"
#include "trimtab/frame/overlays.h"
#include "trimtab/scene/gl_report.h"
#include "views/panels/culling_panel.h"
#include "views/panels/rules_panel.h"
#include "views/panels/terrain_panel.h"

// The commands: one list of actions feeds menus, toolbar, shortcuts and the help on keys.
namespace trimtab::workbench {
namespace {

constexpr int kMostRecent = 8;
constexpr auto kMethodKey = "culling.case";

QString fromView(std::string_view text) {
  return QString::fromUtf8(text.data(), qsizetype(text.size()));
}

/// A window with one long text; stays beside the work.
void showText(QWidget* parent, const QString& title, const QString& markdown) {
  auto* dialog = new QDialog(parent);
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  dialog->setWindowTitle(title);
  dialog->resize(860, 640);
  auto* text = new QTextBrowser(dialog);
  text->setMarkdown(markdown);
  text->setOpenExternalLinks(true);
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Close, dialog);
  QObject::connect(buttons, &QDialogButtonBox::rejected, dialog, &QDialog::close);
  auto* layout = new QVBoxLayout(dialog);
  layout->addWidget(text);
  layout->addWidget(buttons);
  dialog->show();
}

}  // namespace

void MainWindow::makeMenus() {
  makeFileMenu();
  makeEditMenu();
  makeViewMenu();
  makeFlightMenu();
  makeHelpMenu();
  terrainPanel_->setActions(terrainActions_, overlayActions_);
  culling_->setActions(cullingActions_);
}

void MainWindow::makeFileMenu() {
  QMenu* file = menuBar()->addMenu(tr("&File"));
  auto* bar = addToolBar(tr("File"));
  bar->setObjectName(QStringLiteral("file_toolbar"));
  const auto icon = [this](QStyle::StandardPixmap which) { return style()->standardIcon(which); };

  QMenu* fresh = file->addMenu(icon(QStyle::SP_FileIcon), tr("&New preset"));
  for (const std::string_view name : shippedPresets()) {
    QAction* action = fresh->addAction(tr("from %1").arg(fromView(name)), this, [this, name] {
      if (mayLoseEdits()) document_.startFrom(fromView(name));
    });
    if (name == "default") action->setShortcut(QKeySequence::New);
  }
  QAction* open = file->addAction(icon(QStyle::SP_DialogOpenButton), tr("&Open preset..."),
                                  QKeySequence::Open, this, &MainWindow::askOpenPreset);
  QMenu* shipped = file->addMenu(tr("Open s&hipped preset"));
  for (const std::string_view name : shippedPresets())
    shipped->addAction(fromView(name), this, [this, name] {
      if (mayLoseEdits()) openPreset(fromView(name));
    });
  recentMenu_ = file->addMenu(tr("&Recent"));
  connect(recentMenu_, &QMenu::aboutToShow, this, &MainWindow::fillRecentMenu);
  QAction* saveAction = file->addAction(icon(QStyle::SP_DialogSaveButton), tr("&Save preset"),
                                        QKeySequence::Save, this, [this] { save(); });
  file->addAction(tr("Save preset &as..."), QKeySequence(tr("Ctrl+Shift+S")), this, [this] { saveAs(); });
  QAction* exportAction = file->addAction(tr("&Export for an image generator..."), QKeySequence(tr("Ctrl+E")),
                                          this, &MainWindow::askExport);
  auto* const rules = findChild<views::RulesPanel*>();
  file->addAction(tr("&Import rules..."), rules, &views::RulesPanel::askAndImport);
  file->addAction(tr("Export r&ules..."), rules, &views::RulesPanel::askAndExport);
  file->addSeparator();
  QAction* terrain = file->addAction(icon(QStyle::SP_DirOpenIcon), tr("Open &terrain..."),
                                     QKeySequence(tr("Ctrl+T")), this, [this] { askOpenTerrain(false); });
  QAction* folder = file->addAction(tr("Open terrain &folder or database..."),
                                    QKeySequence(tr("Ctrl+Shift+T")), this, [this] { askOpenTerrain(true); });
  QAction* bake = file->addAction(tr("&Bake a terrain database..."), QKeySequence(tr("Ctrl+B")), this,
                                  [this] { askBake(); });
  bake->setToolTip(tr("Elevation, scenery and imagery to one folder that opens at once"));
  file->addAction(tr("Open sa&mple terrain"), this, [this] {
    terrainSource_.clear();
    terrainJob_.openSample();
  });
  file->addSeparator();
  traceAction_ =
      file->addAction(tr("Record tra&ce..."), QKeySequence(tr("Ctrl+R")), this, &MainWindow::askTrace);
  traceAction_->setCheckable(true);
  file->addAction(tr("Open measured resu&lts..."), this, [this] {
    raiseErrors();
    errors_->askOpenResults();
  });
  file->addSeparator();
  file->addAction(tr("&Quit"), QKeySequence(tr("Ctrl+Q")), this, &QWidget::close);

  open->setIconText(tr("Open preset"));
  saveAction->setIconText(tr("Save"));
  exportAction->setIconText(tr("Export"));
  exportAction->setIcon(icon(QStyle::SP_ArrowUp));
  terrain->setIconText(tr("Open terrain"));
  folder->setIconText(tr("Open folder"));
  bake->setIconText(tr("Bake..."));
  terrainActions_ = {terrain, folder, bake};
  bar->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
  bar->addActions({open, saveAction, exportAction, terrain});
}

void MainWindow::makeEditMenu() {
  QMenu* edit = menuBar()->addMenu(tr("&Edit"));
  QAction* undo = draft_.undoStack().createUndoAction(this, tr("&Undo"));
  undo->setShortcut(QKeySequence::Undo);
  undo->setIcon(style()->standardIcon(QStyle::SP_ArrowBack));
  undo->setIconText(tr("Undo"));
  QAction* redo = draft_.undoStack().createRedoAction(this, tr("&Redo"));
  redo->setShortcuts({QKeySequence(tr("Ctrl+Shift+Z")), QKeySequence(tr("Ctrl+Y"))});
  redo->setIcon(style()->standardIcon(QStyle::SP_ArrowForward));
  redo->setIconText(tr("Redo"));
  edit->addActions({undo, redo});
  edit->addSeparator();
  edit->addAction(tr("Reset &all parameters to the base preset"), this, [this] { draft_.resetAll(); });
  auto* bar = addToolBar(tr("Edit"));
  bar->setObjectName(QStringLiteral("edit_toolbar"));
  // The actions' texts name the step and change with it; the toolbar should not jump about.
  for (QAction* action : {undo, redo}) {
    auto* button = new QAction(action->icon(), action->iconText(), this);
    button->setEnabled(action->isEnabled());
    connect(action, &QAction::enabledChanged, button, &QAction::setEnabled);
    connect(action, &QAction::changed, button, [button, action] { button->setToolTip(action->toolTip()); });
    connect(button, &QAction::triggered, action, &QAction::trigger);
    bar->addAction(button);
  }
}

void MainWindow::makeViewMenu() {
  QMenu* view = menuBar()->addMenu(tr("&View"));
  auto* bar = addToolBar(tr("View"));
  bar->setObjectName(QStringLiteral("view_toolbar"));
  bar->setToolButtonStyle(Qt::ToolButtonTextOnly);

  const auto overlay = [this, view](const QString& text, const QString& key, bool Overlays::*flag) {
    QAction* action = view->addAction(text);
    action->setShortcut(QKeySequence(key));
    action->setCheckable(true);
    connect(action, &QAction::toggled, this, [this, flag](bool on) {
      overlays_.*flag = on;
      viewport_->invalidate();
    });
    return action;
  };
  QAction* wireframe = overlay(tr("&Wireframe"), tr("Ctrl+1"), &Overlays::wireframe);
  QAction* bounds = overlay(tr("Tile &bounds"), tr("Ctrl+2"), &Overlays::tileBounds);
  QAction* byReason = overlay(tr("Colour by &reason"), tr("Ctrl+3"), &Overlays::colourByReason);
  QAction* byLevel = overlay(tr("Colour by &level"), tr("Ctrl+4"), &Overlays::colourByLevel);
  QAction* voids = overlay(tr("Filled &voids"), tr("Ctrl+5"), &Overlays::voids);
  voids->setToolTip(tr("Posts that the sources leave open stand out; seen where patches are drawn"));
  // A tile has one colour.
  connect(byReason, &QAction::toggled, byLevel, [byLevel](bool on) {
    if (on) byLevel->setChecked(false);
  });
  connect(byLevel, &QAction::toggled, byReason, [byReason](bool on) {
    if (on) byReason->setChecked(false);
  });
  freezeAction_ = view->addAction(tr("&Freeze culling"));
  freezeAction_->setShortcut(QKeySequence(tr("Ctrl+F")));
  freezeAction_->setCheckable(true);
  freezeAction_->setToolTip(tr("Tiles and levels stay as of now while the view flies on"));
  connect(freezeAction_, &QAction::toggled, this, &MainWindow::setFrozen);
  view->addSeparator();

  QMenu* cases = view->addMenu(tr("&Culling case"));
  caseActions_ = new QActionGroup(this);
  if (const ParameterRow* row = findRow(kMethodKey)) {
    for (std::size_t i = 0; i < row->choices.size(); ++i) {
      QAction* action = cases->addAction(fromView(row->choices[i].label), this,
                                         [this, i] { draft_.setValue(kMethodKey, ChoiceIndex{i}); });
      action->setShortcut(QKeySequence(tr("Ctrl+Alt+%1").arg(i + 1)));
      action->setCheckable(true);
      caseActions_->addAction(action);
    }
    const auto showCase = [this] {
      const ParameterValue value = draft_.value(kMethodKey);
      const auto* choice = std::get_if<ChoiceIndex>(&value);
      const QList<QAction*> actions = caseActions_->actions();
      if (choice != nullptr && choice->index < std::size_t(actions.size()))
        actions[qsizetype(choice->index)]->setChecked(true);
    };
    connect(&draft_, &views::Draft::valueChanged, this, [showCase](const QString& key) {
      if (key == QLatin1String(kMethodKey)) showCase();
    });
    showCase();
  }
  view->addAction(tr("&Place the camera over the terrain"), QKeySequence(Qt::Key_Home), this, [this] {
    if (!terrain_ || feed_.source() != Feed::Source::camera) return;
    placeCamera();
    feed_.look(viewport_->camera());
  });
  view->addAction(tr("Compare &two presets..."), QKeySequence(tr("Ctrl+D")), this,
                  &MainWindow::showSplitView);
  view->addSeparator();
  dockMenu_ = view->addMenu(tr("&Docks"));
  int number = 1;
  for (QDockWidget* each : findChildren<QDockWidget*>(QString(), Qt::FindDirectChildrenOnly)) {
    QAction* show = each->toggleViewAction();
    show->setShortcut(QKeySequence(tr("Alt+%1").arg(number++)));
    connect(show, &QAction::triggered, each, [each](bool on) {
      if (on) each->raise();
    });
    dockMenu_->addAction(show);
  }
  view->addAction(tr("Reset la&yout"), this, &MainWindow::resetLayout);
  bar->addActions({wireframe, bounds, byReason, byLevel, freezeAction_});
  overlayActions_ = {byLevel, wireframe, bounds, voids};
  cullingActions_ = {byReason, bounds, freezeAction_};
}

void MainWindow::makeFlightMenu() {
  QMenu* flight = menuBar()->addMenu(tr("F&light"));
  flight->addAction(tr("&Open flight..."), QKeySequence(tr("Ctrl+L")), this, &MainWindow::askOpenFlight);
  flight->addAction(tr("&Play or pause"), QKeySequence(Qt::Key_F5), this,
                    [this] { flightDock_->playing() ? flightDock_->pause() : flightDock_->play(); });
  flight->addAction(tr("&Back to the start"), QKeySequence(tr("Shift+F5")), flightDock_, &FlightDock::stop);
  flight->addAction(tr("&Measure presets along it..."), QKeySequence(tr("Ctrl+M")), this, [this] {
    raiseErrors();
    errors_->askAndMeasure();
  });
  flight->addSeparator();
  flight->addAction(tr("&Connect or disconnect the host"), QKeySequence(Qt::Key_F6), this, [this] {
    if (feed_.receiver() != nullptr)
      feed_.closeHost();
    else
      hostDock_->connectHost();
  });
}

void MainWindow::makeHelpMenu() {
  QMenu* help = menuBar()->addMenu(tr("&Help"));
  help->addAction(tr("&Keys and mouse"), QKeySequence::HelpContents, this, &MainWindow::showKeys);
  help->addAction(tr("&Parameter reference"), QKeySequence(tr("Shift+F1")), this, &MainWindow::showReference);
  help->addSeparator();
  help->addAction(tr("&About Trimtab"), this, &MainWindow::showAbout);
}

void MainWindow::remember(const QString& kind, const QString& path) {
  QSettings settings;
  QStringList paths = settings.value(QStringLiteral("recent/") + kind).toStringList();
  paths.removeAll(path);
  paths.prepend(path);
  settings.setValue(QStringLiteral("recent/") + kind, QStringList(paths.mid(0, kMostRecent)));
}

void MainWindow::fillRecentMenu() {
  recentMenu_->clear();
  const std::pair<QString, QString> kinds[] = {{QStringLiteral("preset"), tr("Presets")},
                                               {QStringLiteral("terrain"), tr("Terrain")},
                                               {QStringLiteral("flight"), tr("Flights")}};
  for (const auto& [kind, title] : kinds) {
    const QStringList paths = QSettings().value(QStringLiteral("recent/") + kind).toStringList();
    if (paths.isEmpty()) continue;
    recentMenu_->addSection(title);
    for (const QString& path : paths) {
      QAction* action = recentMenu_->addAction(QFileInfo(path).fileName(), this, [this, path, which = kind] {
        if (which == QLatin1String("terrain"))
          openTerrain(path);
        else if (which == QLatin1String("flight"))
          openFlight(path);
        else if (mayLoseEdits())
          openPreset(path);
      });
      action->setToolTip(path);
      action->setEnabled(QFileInfo::exists(path));
    }
  }
  if (recentMenu_->isEmpty()) recentMenu_->addAction(tr("nothing yet"))->setEnabled(false);
  recentMenu_->setToolTipsVisible(true);
}

void MainWindow::showKeys() {
  QString text = tr(
      "## Free camera\n\nWhile neither a host nor a flight moves the aircraft and the view has the focus.\n\n"
      "| Keys | What they do |\n|---|---|\n"
      "| drag with the left button | look around |\n| wheel | faster, slower |\n"
      "| W, S | ahead, back |\n| A, D | left, right |\n| E or Page Up, Q or Page Down | up, down |\n"
      "| arrow keys | turn and tilt |\n\n"
      "## Run time against error\n\n| Keys | What they do |\n|---|---|\n"
      "| left, right | in the plot the point before or after; along the flight the frame, with Shift ten |\n"
      "| L, F | frame time by the logarithm; fit the view |\n| W, Shift+W | next and last worst frame |\n"
      "| plus, minus | zoom |\n\n## Commands\n\n| Keys | What they do |\n|---|---|\n");
  for (QMenu* menu : menuBar()->findChildren<QMenu*>()) {
    for (const QAction* action : menu->actions()) {
      if (action->shortcut().isEmpty()) continue;
      text += QStringLiteral("| %1 | %2 |\n")
                  .arg(action->shortcut().toString(QKeySequence::NativeText),
                       QString(action->text()).remove('&').remove(QStringLiteral("...")));
    }
  }
  showText(this, tr("Keys and mouse"), text);
}

void MainWindow::showReference() {
  showText(this, tr("Parameter reference"), QString::fromStdString(parameterReference()));
}

void MainWindow::showAbout() {
  const scene::GlReport& gl = viewport_->gl();
  QMessageBox::about(
      this, tr("About Trimtab"),
      tr("<h3>Trimtab %1</h3><p>Tune culling and level of detail of flight simulator image generators while "
         "you watch "
         "what each setting does.</p><p>The workbench is free software under the GNU General Public License, "
         "version 3 or "
         "later; the library that image generators link is under the MIT licence.</p><p>OpenGL: %2, %3%4</p>"
         "<p>Terrain: %5</p>")
          .arg(QStringLiteral(TRIMTAB_VERSION), QString::fromStdString(gl.renderer).toHtmlEscaped(),
               QString::fromStdString(gl.version).toHtmlEscaped(),
               gl.software ? tr(" (software)") : QString(),
               QString::fromStdString(gl.drawing).toHtmlEscaped()));
}

}  // namespace trimtab::workbench
