// SPDX-License-Identifier: GPL-3.0-or-later
#include "main_window.h"

#include <QCloseEvent>
#include <QCoreApplication>
#include <QDockWidget>
#include <QDragEnterEvent>
#include <QDropEvent>
#include <QFileDialog>
#include <QFileInfo>
#include <QMenuBar>
#include <QMimeData>
#include <QSettings>
#include <QStatusBar>
#include <QTabBar>
#include <QTabWidget>
#include <QTimer>
#include <QVBoxLayout>
#include <cstdio>

#include "app/workbench/controllers/file_kind.h"
#include "app/workbench/controllers/recent_files.h"
#include "app/workbench/dialogs/notice_bar.h"
#include "app/workbench/docks/changes_dock.h"
#include "app/workbench/docks/dock_of.h"
#include "app/workbench/docks/error_dock.h"
#include "app/workbench/docks/flight_dock.h"
#include "app/workbench/docks/host_dock.h"
#include "app/workbench/docks/message_panel.h"
#include "app/workbench/viewport/split_view.h"
#include "app/workbench/window/palette_entries.h"
#include "appearance.h"
#include "job_bar.h"
#include "menus.h"
#include "plots_link.h"
#include "session_keeper.h"
#include "status_strip.h"
#include "trimtab/units/labelled.h"
#include "views/panels/budget_strip.h"
#include "views/panels/plots_panel.h"
#include "views/panels/static_lod_panel.h"
#include "views/plots/plot_picture.h"
#include "views/policy/policy_panel.h"
#include "views/policy/scheme_page.h"
#include "welcome.h"
#include "workspace_bar.h"
#include "workspaces.h"

namespace trimtab::workbench {
namespace {

constexpr int kSavedMs = 4000, kHintMs = 8000;
constexpr qsizetype kWelcomed = 3, kRecent = 2;
const QString kPlotsGroup = QStringLiteral("workspace_plots/");
const QString kGeometryKey = QStringLiteral("window/geometry");

}  // namespace

MainWindow::MainWindow() {
  applyChosen();
  setObjectName(QStringLiteral("trimtab"));
  setDockOptions(AnimatedDocks | AllowNestedDocks | AllowTabbedDocks | GroupedDragging);
  setAcceptDrops(true);
  setTabPosition(Qt::AllDockWidgetAreas, QTabWidget::North);
  makeMiddle();
  panels_ = makePanels(docks_, draft_, feed_);
  makeControllers();
  makeStatusBar();
  makeMenus();
  connectParts();
  restoreSize();
  updateTitle();
}

MainWindow::~MainWindow() {
  // Docks and viewport use the members, so they go first. Meanwhile nothing may call into a controller whose
  // docks are gone.
  controllers_.trace->stop();
  pause_.disconnect(this);
  feed_.disconnect();
  viewport_->disconnect();
  viewport_->setSource({});
  qDeleteAll(findChildren<QDockWidget*>(QString(), Qt::FindDirectChildrenOnly));
  delete takeCentralWidget();
}

void MainWindow::makeMiddle() {
  auto* middle = new QWidget(this);
  auto* column = new QVBoxLayout(middle);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(0);
  viewport_ = new Viewport(middle);
  column->addWidget(viewport_, 1);
  strip_ = new views::BudgetStrip(draft_, middle);
  column->addWidget(strip_);
  notices_ = new NoticeBar(middle);
  setCentralWidget(middle);
}

void MainWindow::makeControllers() {
  const Workplace at{draft_, feed_, *viewport_, pause_, *panels_.messages, *this};
  Controllers& c = controllers_;
  c.document = std::make_unique<DocumentController>(at, *notices_);
  c.ig = std::make_unique<IgController>(at, c.document->document());
  c.terrain = std::make_unique<TerrainController>(at, *panels_.terrain, *panels_.staticLod);
  c.observer = std::make_unique<ObserverController>(at, *c.terrain);
  c.frame = std::make_unique<FrameController>(at, *c.terrain, *c.observer);
  c.culling = std::make_unique<CullingController>(at, *c.frame, *c.terrain, *panels_.culling);
  c.flight = std::make_unique<FlightController>(at, *c.observer, *c.terrain, *panels_.flight, *panels_.host);
  c.head = std::make_unique<HeadController>(at, *panels_.motion);
  c.symbology = std::make_unique<SymbologyController>(at, *panels_.symbology);
  c.weather = std::make_unique<WeatherController>(at, *c.frame, *c.terrain, *panels_.weather);
  c.trace = std::make_unique<TraceController>(at, *c.frame);
  c.inputs = std::make_unique<RunInputs>(at, c.document->document(), *c.terrain, *panels_.flight);
  c.errors = std::make_unique<ErrorsController>(
      at, measuring_, ErrorsController::Neighbours{*c.frame, *c.terrain, *c.flight, *c.trace, *c.inputs});

  using enum DockLayout::Place;
  docks_.add("errors", tr("Run time against error"), foot, &c.errors->dock());
  docks_.join("errors", tr("Compare"), &c.errors->splitView());
  addRunPages(docks_, panels_, c, draft_, pause_);
  docks_.setQuestion("errors", tr("What does a preset cost, and what error does it make?"));
  workspaces_ = new Workspaces(*this, docks_);
  sessions_ = new SessionKeeper(at, controllers_, *workspaces_, panels_.changes->snapshots());
  c.errors->attach();
  // Results are a wide table, for which the other workspaces have no place.
  connect(c.errors.get(), &ErrorsController::placeWanted, workspaces_,
          [this] { workspaces_->show(Workspaces::kMeasure); });
}

void MainWindow::makeStatusBar() {
  auto* strip = new StatusStrip(feed_, draft_, this);
  statusBar()->addPermanentWidget(new JobBar(controllers_.terrain->job(), this));
  statusBar()->addPermanentWidget(strip);
  connect(controllers_.flight.get(), &FlightController::sourceTextChanged, strip, &StatusStrip::showSource);
  connect(controllers_.trace.get(), &TraceController::recordingChanged, strip, &StatusStrip::showRecording);
  connect(controllers_.frame.get(), &FrameController::frameShown, strip, &StatusStrip::showFrame);
  connect(workspaces_, &Workspaces::currentChanged, strip,
          [this, strip](int index) { strip->showWorkspace(workspaces_->names()[index]); });
  connect(controllers_.document.get(), &DocumentController::saved, this,
          [this](const QString& file) { statusBar()->showMessage(tr("Saved %1").arg(file), kSavedMs); });
  connect(controllers_.document.get(), &DocumentController::exported, this,
          [this](const QString& file) { statusBar()->showMessage(tr("Exported %1").arg(file), kSavedMs); });
  connect(controllers_.errors.get(), &ErrorsController::hint, this,
          [this](const QString& text) { statusBar()->showMessage(text, kHintMs); });
}

void MainWindow::makeMenus() {
  const Workplace at{draft_, feed_, *viewport_, pause_, *panels_.messages, *this};
  auto* menus = new Menus(*this, at, controllers_, panels_, *sessions_);
  connect(menus, &Menus::everyDockAsked, this, &MainWindow::showEveryDock);
  connect(menus, &Menus::importAsked, this, &MainWindow::askImport);
  connect(menus, &Menus::welcomeAsked, this, &MainWindow::welcome);
  // Beside the menus, where it costs the image no height.
  menuBar()->setCornerWidget(new WorkspaceBar(*workspaces_, menus->workspaces(), messages(), this));
}

void MainWindow::connectParts() {
  const Controllers& c = controllers_;
  connect(c.frame.get(), &FrameController::frameShown, this,
          [this](const views::LiveFrame& frame) { docks_.showFrame(frame); });
  connect(strip_, &views::BudgetStrip::knobAsked, this,
          [this](const QString& key) { openParameter(*panels_.parameters, key.toStdString()); });
  strip_->setCosts(
      [this](const FrameLoad& load) { return feed_.session().hold().model().coefficients(load); });
  connect(c.frame.get(), &FrameController::frameShown, strip_, [this](const views::LiveFrame& frame) {
    if (const auto& shown = controllers_.frame->shown())
      strip_->showFrame(frame, 1e-6 * shown->view.widthPx * shown->view.heightPx);
  });
  connect(c.frame.get(), &FrameController::painted, this, &MainWindow::takeScreenshotSoon);
  connect(c.terrain.get(), &TerrainController::opened, this, [this] {
    controllers_.document->setTerrainName(
        QString::fromStdString(controllers_.terrain->database()->info().name));
    updateTitle();
  });
  connect(c.observer.get(), &ObserverController::frozenChanged, c.culling.get(), [this](bool frozen) {
    if (!frozen) controllers_.culling->forgetPicked();
  });
  connect(panels_.staticLod, &views::StaticLodPanel::overlayChanged, c.culling.get(),
          &CullingController::setTreeOverlay);
  connect(&draft_, &views::Draft::dirtyChanged, this, &MainWindow::updateTitle);
  connect(&c.document->document(), &Document::fileChanged, this, &MainWindow::updateTitle);

  connectPlots(panels_, controllers_, feed_);
  connect(workspaces_, &Workspaces::currentChanged, this, &MainWindow::showPlotsOf);
  connect(&c.errors->dock().live(), &LiveMeter::measured, panels_.changes,
          [this](const LiveMeter::Measured& m) {
            if (!controllers_.observer->frozen()) panels_.changes->snapshots().addError(m.error.flip);
          });
  whenSeen(*panels_.changes, panels_.changes,
           [changes = panels_.changes](bool seen) { changes->setSeen(seen); });
  connect(panels_.changes, &ChangesDock::errorsWanted, &c.errors->dock(),
          [this](bool wanted) { controllers_.errors->dock().setWatched(panels_.changes, wanted); });

  connectPause();

  MessagePanel* const messages = panels_.messages;
  connect(messages, &MessagePanel::errorAdded, messages, [messages] { raiseDock(*messages); });
  connect(panels_.policy, &views::PolicyPanel::imported, messages, &MessagePanel::add);
  connect(panels_.host, &HostDock::refused, messages, &MessagePanel::add);
  connect(panels_.flight, &FlightDock::refused, messages, &MessagePanel::add);
}

/// Whatever measures times has the machine for itself.
void MainWindow::connectPause() {
  pause_.follow(controllers_.errors->dock().child(), &ChildRun::workingChanged, tr("presets are measured"));
  // Comparing says so itself: it goes on and off all the time.
  pause_.follow(controllers_.errors->splitView(), &SplitView::busyChanged, {});
  connect(&pause_, &ViewPause::changed, this, &MainWindow::showPause);
}

void MainWindow::showPause() {
  viewport_->setPaused(pause_.on(), pause_.text());
  measuring_.setHeld(pause_.onBut(controllers_.errors->splitView()));
  feed_.setImagesDrawn(!isMinimized() && !pause_.on());
}

void MainWindow::restoreSize() {
  resize(1600, 1000);
  const QSettings settings;
  restoreGeometry(settings.value(kGeometryKey).toByteArray());
  panels_.plots->readFrom(settings);
  panels_.plots->readLengthFrom(settings);
}

/// Each workspace has its plots; one that was never left takes over those that are shown.
void MainWindow::showPlotsOf(int workspace) {
  keepPlots();
  plotsOf_ = workspaces_->names()[workspace];
  QSettings settings;
  settings.beginGroup(kPlotsGroup + plotsOf_);
  if (!settings.childGroups().isEmpty()) panels_.plots->readFrom(settings);
}

void MainWindow::keepPlots() const {
  if (plotsOf_.isEmpty()) return;
  QSettings settings;
  settings.beginGroup(kPlotsGroup + plotsOf_);
  panels_.plots->keepIn(settings);
}

void MainWindow::updateTitle() {
  const auto& terrain = controllers_.terrain->database();
  const QString over =
      terrain ? QStringLiteral(" – ") + QString::fromStdString(terrain->info().name) : QString();
  setWindowTitle(controllers_.document->document().title() + QStringLiteral("[*]") + over +
                 QStringLiteral(" – Trimtab"));
  setWindowModified(draft_.isDirty());
}

void MainWindow::openAny(const QString& path) {
  const Controllers& c = controllers_;
  switch (fileKindOf(path)) {
    case FileKind::results:
      c.errors->openResults(path);
      return;
    case FileKind::workspace:
      if (const Findings findings = workspaces_->readFrom(path); !findings.empty())
        messages().add(tr("The workspace cannot be used: %1").arg(path), findings);
      return;
    case FileKind::session:
      sessions_->open(path);
      return;
    case FileKind::preset:
      return c.document->openOverEdits(path);
    case FileKind::rules:
      if (const auto findings = panels_.policy->importFile(path))
        messages().add(
            (hasError(*findings) ? tr("%1 is no policy") : tr("The policy was imported: %1")).arg(path),
            *findings);
      return;
    case FileKind::head_log:
      c.head->open(path);
      return;
    case FileKind::flight:
      c.flight->open(path);
      return;
    case FileKind::terrain:
      return c.terrain->open(terrainOf(path));
  }
}

void MainWindow::askImport() {
  const QString file =
      QFileDialog::getOpenFileName(this, tr("Import"), {}, tr("Policies (*.fll *.fis);;All files (*)"));
  if (!file.isEmpty()) openAny(file);
}

void MainWindow::dragEnterEvent(QDragEnterEvent* event) {
  if (event->mimeData()->hasUrls()) event->acceptProposedAction();
}

void MainWindow::dropEvent(QDropEvent* event) {
  for (const QUrl& url : event->mimeData()->urls()) {
    if (url.isLocalFile())
      openAny(url.toLocalFile());
    else
      messages().add(
          tr("Only files of this machine can be dropped"),
          {{Severity::error, url.toString().toStdString(), "", "a local file", url.scheme().toStdString()}});
  }
  event->acceptProposedAction();
}

/// Qt makes bars of tabs whenever docks come together, also when a layout is restored.
void MainWindow::childEvent(QChildEvent* event) {
  QMainWindow::childEvent(event);
  if (auto* bar = event->polished() ? qobject_cast<QTabBar*>(event->child()) : nullptr) arrangeTabs(*bar);
}

bool MainWindow::event(QEvent* event) {
  const bool known = QMainWindow::event(event);
  if (event->type() == QEvent::WindowStateChange) showPause();
  if (event->type() == QEvent::Resize) docks_.keepShares();
  // A person lets go of a handle between docks. Clicks that nobody takes arrive here too, not accepted.
  if (event->type() == QEvent::MouseButtonRelease && event->isAccepted()) docks_.noteShares(size());
  return known;
}

void MainWindow::closeEvent(QCloseEvent* event) {
  if (!controllers_.document->mayLoseEdits()) return event->ignore();
  controllers_.document->document().dropCopy();
  sessions_->keepLast();
  QSettings settings;
  settings.setValue(kGeometryKey, saveGeometry());
  workspaces_->keep();
  keepPlots();
  panels_.plots->keepIn(settings);
  panels_.plots->keepLengthIn(settings);
  controllers_.trace->stop();
  feed_.closeHost();
  event->accept();
}

void MainWindow::start(const Options& options) {
  const Controllers& c = controllers_;
  options_ = options;
  screenshotDue_ = options.afterS >= 0 && !options.screenshot.isEmpty();
  if (options.window) {
    setWindowState(windowState() & ~(Qt::WindowMaximized | Qt::WindowFullScreen));
    resize(*options.window);
  }
  workspaces_->begin();
  show();
  docks_.noteShares(size());
  viewport_->setFocus();
  if (!options.preset.isEmpty()) c.document->open(options.preset);
  if (options.terrain.isEmpty())
    c.terrain->openSample();
  else
    c.terrain->open(options.terrain, options.origin);
  if (!options.flight.isEmpty() && c.flight->open(options.flight)) panels_.flight->play();
  if (!options.head.isEmpty()) c.head->open(options.head);
  if (options.listenPort) {
    panels_.host->setPort(*options.listenPort);
    if (!options.bind.isEmpty()) panels_.host->setInterface(options.bind);
    if (!options.from.isEmpty()) panels_.host->setSender(options.from);
    panels_.host->connectHost();
  }
  for (const QString& file : options.files) openAny(file);
  if (options.welcome && Welcome::shownAtStart()) welcome();
  if (options.screenshot.isEmpty()) {
    if (!options.exportFile.isEmpty())
      c.document->exportTo(options.exportFile, exportFormatOf(options.exportFile), {}, {});
    c.document->offerRecovery();
  }
}

void MainWindow::welcome() {
  const auto nameOf = [](const QString& path) { return QFileInfo(path).fileName(); };
  Welcome::Group again{tr("Go on"), {}};
  if (const QString last = SessionKeeper::lastFile(); QFileInfo::exists(last))
    again.ways.push_back({tr("Where you left off"),
                          tr("terrain, preset, flight and workspace of the last time"),
                          [this, last] { sessions_->open(last); }});
  for (const QString& path : recentFiles(QStringLiteral("session")).mid(0, kWelcomed))
    if (QFileInfo::exists(path))
      again.ways.push_back({nameOf(path), path, [this, path] { sessions_->open(path); }});
  Welcome::Group recent{tr("Recent"), {}};
  const auto addRecent = [&](const QString& kind, const QString& detail, const auto& open) {
    for (const QString& path : recentFiles(kind).mid(0, kRecent))
      if (QFileInfo::exists(path))
        recent.ways.push_back({nameOf(path), detail.arg(path), [open, path] { open(path); }});
  };
  addRecent(QStringLiteral("terrain"), tr("terrain: %1"),
            [this](const QString& path) { controllers_.terrain->open(path); });
  addRecent(QStringLiteral("flight"), tr("flight: %1"),
            [this](const QString& path) { controllers_.flight->open(path); });
  Welcome::Group open{
      tr("Open or import"),
      {{tr("A terrain"), tr("a folder: elevation, scenery, CDB, database"),
        [this] { controllers_.terrain->askOpenFolder(); }},
       {tr("A preset"), tr("a JSON file of this program"), [this] { controllers_.document->askOpen(); }},
       {tr("A session"), tr("what was saved together"), [this] { sessions_->askOpen(); }}}};
  const auto openSample = [this] {
    // At a start with nothing to open it is open already, or opening.
    TerrainController& terrain = *controllers_.terrain;
    const bool there = terrain.database() || terrain.job().running();
    if (!there || !terrain.askedFor().isEmpty()) terrain.openSample();
  };
  Welcome::Group begin{
      tr("Begin"),
      {{tr("The sample terrain"), tr("100 km of mountains, woods and a town, with the camera over them"),
        openSample},
       {tr("A host"), tr("listen to a flight simulator over UDP: workspace Connect"),
        [this] {
          workspaces_->show(int(workspaces_->names().indexOf(tr("Connect"))));
          goTo(*dockOf(*panels_.host));
        }},
       {tr("A flight"), tr("a recorded flight or capture"), [this] { controllers_.flight->askOpen(); }}}};
  for (const QString& path : shippedFlights())
    if (nameOf(path) == QLatin1String("yecheon-circuit.csv"))
      begin.ways.insert(begin.ways.begin() + 1,
                        {tr("The sample flight"), tr("a circuit over the sample terrain, played here"),
                         [this, openSample, path] {
                           openSample();
                           if (controllers_.flight->open(path)) feed_.playHere();
                         }});
  (new Welcome({again, begin, open, recent}, this))->open();
}

void MainWindow::takeScreenshotSoon() {
  if (!screenshotDue_) return;
  screenshotDue_ = false;
  QTimer::singleShot(static_cast<int>(options_.afterS * 1000), this, &MainWindow::takeScreenshot);
}

void MainWindow::takeScreenshot() {
  const Findings findings = views::writePixmap(grab(), options_.screenshot);
  bool good = !hasError(findings);
  std::fputs(labelled(findings).c_str(), stderr);
  if (!good)
    std::fprintf(stderr, "trimtab: the screenshot cannot be saved: %s\n", qPrintable(options_.screenshot));
  if (!options_.exportFile.isEmpty())
    good =
        controllers_.document->exportTo(options_.exportFile, exportFormatOf(options_.exportFile), {}, {}) &&
        good;
  keepUnsavedEdits();
  QCoreApplication::exit(good ? 0 : 1);
}

void MainWindow::keepUnsavedEdits() {
  controllers_.document->document().keepCopyNow();
  controllers_.trace->stop();
}

}  // namespace trimtab::workbench
