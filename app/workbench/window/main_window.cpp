// SPDX-License-Identifier: GPL-3.0-or-later
#include "main_window.h"

#include <QCloseEvent>
#include <QDockWidget>
#include <QFileInfo>
#include <QLabel>
#include <QProgressBar>
#include <QPushButton>
#include <QScreen>
#include <QSettings>
#include <QStatusBar>
#include <QVBoxLayout>

#include "app/workbench/docks/experiments_dock.h"
#include "app/workbench/docks/flight_dock.h"
#include "app/workbench/docks/host_dock.h"
#include "app/workbench/viewport/split_view.h"
#include "notice_bar.h"
#include "trimtab/terrain/format/database.h"
#include "views/editors/bands_editor.h"
#include "views/panels/plots_panel.h"
#include "views/plots/time_plot.h"

namespace trimtab::workbench {
namespace {

/// Raised when docks come or go, so that an old layout is not forced on new docks.
constexpr int kLayoutVersion = 3;
const QString kSpanKey = QStringLiteral("plots/span_s");

}  // namespace

MainWindow::MainWindow() {
  sinceStart_.start();
  setObjectName(QStringLiteral("trimtab"));
  setDockOptions(AnimatedDocks | AllowNestedDocks | AllowTabbedDocks | GroupedDragging);
  setAcceptDrops(true);
  setTabPosition(Qt::AllDockWidgetAreas, QTabWidget::North);

  auto* middle = new QWidget(this);
  auto* column = new QVBoxLayout(middle);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(0);
  notices_ = new NoticeBar(middle);
  viewport_ = new Viewport(middle);
  column->addWidget(notices_);
  column->addWidget(viewport_, 1);
  setCentralWidget(middle);

  makeDocks();
  makeStatusBar();
  makeMenus();
  connectParts();
  arrangeDocks();
  resize(1600, 1000);
  defaultLayout_ = saveState(kLayoutVersion);
  const QSettings settings;
  restoreGeometry(settings.value(QStringLiteral("window/geometry")).toByteArray());
  restoreState(settings.value(QStringLiteral("window/state")).toByteArray(), kLayoutVersion);
  if (const double span = settings.value(kSpanKey).toDouble(); span > 0) plots_->setSpan(span);
  updateTitle();
}

MainWindow::~MainWindow() {
  // Docks and viewport use the draft and the feed, which are members: they go first, and report to nobody.
  disconnect(&feed_, nullptr, this, nullptr);
  disconnect(&terrainJob_, nullptr, this, nullptr);
  disconnect(viewport_, nullptr, this, nullptr);
  viewport_->setSource({});
  stopTrace();
  delete split_;
  qDeleteAll(findChildren<QDockWidget*>(QString(), Qt::FindDirectChildrenOnly));
  delete takeCentralWidget();
}

void MainWindow::resetLayout() {
  restoreState(defaultLayout_, kLayoutVersion);
  arrangeDocks();
}

void MainWindow::makeStatusBar() {
  sourceLabel_ = new QLabel(this);
  jobLabel_ = new QLabel(this);
  jobBar_ = new QProgressBar(this);
  jobBar_->setMaximumWidth(220);
  jobBar_->setRange(0, 100);
  jobCancel_ = new QPushButton(tr("Cancel"), this);
  connect(jobCancel_, &QPushButton::clicked, &terrainJob_, &TerrainJob::cancel);
  statusBar()->addPermanentWidget(jobLabel_);
  statusBar()->addPermanentWidget(jobBar_);
  statusBar()->addPermanentWidget(jobCancel_);
  statusBar()->addPermanentWidget(sourceLabel_);
  for (QWidget* part :
       {static_cast<QWidget*>(jobLabel_), static_cast<QWidget*>(jobBar_), static_cast<QWidget*>(jobCancel_)})
    part->hide();
}

void MainWindow::connectParts() {
  viewport_->setSource([this](int widthPx, int heightPx) { return picture(widthPx, heightPx); });
  connect(viewport_, &Viewport::painted, this, &MainWindow::onPainted);
  connect(viewport_, &Viewport::cameraMoved, this, [this] { feed_.look(viewport_->camera()); });
  connect(viewport_, &Viewport::glFailed, this, [this](const QString& why) {
    messages_->add(tr("The terrain cannot be drawn"),
                   {{Severity::error, "OpenGL", "", "what the renderer needs", why.toStdString()}});
  });

  connect(&feed_, &Feed::statesArrived, viewport_, &Viewport::invalidate);
  connect(&feed_, &Feed::decisionChanged, this, &MainWindow::onDecision);
  connect(&feed_, &Feed::sourceChanged, this, &MainWindow::onSource);
  connect(&feed_, &Feed::linkChanged, this, &MainWindow::onLink);
  connect(&feed_, &Feed::flightChanged, this, [this] {
    onSource();
    viewport_->invalidate();
  });
  connect(&feed_, &Feed::jumped, this, [this] {
    messages_->note(
        tr("The host moved the aircraft farther than it can fly (jump %L1)").arg(feed_.session().jumps()));
  });

  connect(&draft_, &views::Draft::activeChanged, this, [this] {
    feed_.session().setParameters(draft_.active());
    onDecision();
    viewport_->invalidate();
  });
  connect(&draft_, &views::Draft::dirtyChanged, this, &MainWindow::updateTitle);
  connect(&document_, &Document::fileChanged, this, &MainWindow::updateTitle);
  connect(&document_, &Document::changedOnDisk, this, &MainWindow::onChangedOnDisk);

  connect(messages_, &MessagePanel::errorAdded, this, [this] {
    dock(QStringLiteral("messages"))->show();
    dock(QStringLiteral("messages"))->raise();
  });
  const auto refused = [this](const QString& what, const Findings& findings) {
    messages_->add(what, findings);
  };
  connect(hostDock_, &HostDock::refused, this, refused);
  connect(flightDock_, &FlightDock::refused, this, refused);
  connect(experiments_, &ExperimentsDock::refused, this, refused);
  connect(flightDock_, &FlightDock::openRequested, this, &MainWindow::askOpenFlight);

  const auto showJob = [this](bool on) {
    jobLabel_->setVisible(on);
    jobBar_->setVisible(on);
    jobCancel_->setVisible(on);
  };
  connect(&terrainJob_, &TerrainJob::started, this, [this, showJob](const QString& what) {
    jobLabel_->setText(what);
    jobBar_->setValue(0);
    showJob(true);
    if (!terrain_) viewport_->setNotice(tr("%1...").arg(what));
  });
  connect(&terrainJob_, &TerrainJob::progressed, this, [this](double fraction, const QString& what) {
    jobBar_->setValue(static_cast<int>(fraction * 100));
    if (!what.isEmpty()) jobLabel_->setText(what);
  });
  const QString hint =
      tr("No terrain is open.\nFile > Open terrain, or drop an elevation file or a folder here.");
  connect(&terrainJob_, &TerrainJob::cancelled, this, [this, showJob, hint] {
    showJob(false);
    messages_->note(tr("Cancelled: the terrain stays as it was"));
    viewport_->setNotice(hint);
  });
  connect(&terrainJob_, &TerrainJob::failed, this, [this, showJob, hint](const Findings& findings) {
    showJob(false);
    messages_->add(tr("The terrain cannot be opened"), findings);
    viewport_->setNotice(hint);
  });
  connect(&terrainJob_, &TerrainJob::opened, this,
          [this, showJob](std::shared_ptr<const terrain::Database> database, const Findings& findings) {
            showJob(false);
            onTerrainOpened(std::move(database));
            if (!findings.empty())
              messages_->add(tr("Opened %1").arg(QFileInfo(openedTerrain_).fileName()), findings);
          });
}

void MainWindow::closeEvent(QCloseEvent* event) {
  if (!mayLoseEdits()) return event->ignore();
  document_.dropCopy();
  QSettings settings;
  settings.setValue(QStringLiteral("window/geometry"), saveGeometry());
  settings.setValue(QStringLiteral("window/state"), saveState(kLayoutVersion));
  settings.setValue(kSpanKey, plots_->plot().span());
  stopTrace();
  feed_.closeHost();
  event->accept();
}

}  // namespace trimtab::workbench
