// SPDX-License-Identifier: GPL-3.0-or-later
#include "errors_controller.h"

#include <QCheckBox>
#include <QDockWidget>
#include <QFile>
#include <QFileInfo>
#include <QMainWindow>
#include <QRegularExpression>
#include <limits>

#include "app/workbench/docks/dock_of.h"
#include "app/workbench/docks/flight_dock.h"
#include "app/workbench/docks/message_panel.h"
#include "app/workbench/jobs/feed.h"
#include "app/workbench/viewport/split_view.h"
#include "app/workbench/viewport/viewport.h"
#include "flight_controller.h"
#include "frame_controller.h"
#include "terrain_controller.h"
#include "trace_controller.h"

namespace trimtab::workbench {
namespace {

/// A blur over more images than these mixes in nothing that shows.
constexpr std::size_t kRemembered = 16;
constexpr double kSameTimeS = 1e-6;

QString plainName(QString name) {
  return name.replace(QRegularExpression(QStringLiteral("[^A-Za-z0-9._-]+")), QStringLiteral("-"));
}

/// Gives the file another stem, because the stem is its name in the results. Returns the file as it is if it
/// cannot be renamed.
QString renamed(const QString& file, const QString& stem) {
  const QFileInfo info(file);
  const QString to = QStringLiteral("%1/%2.%3").arg(info.path(), plainName(stem), info.suffix());
  if (to == file) return file;
  QFile::remove(to);
  return QFile::rename(file, to) ? to : file;
}

QString stemOf(const Flight& flight) {
  return QFileInfo(QString::fromStdString(flight.name)).completeBaseName();
}

/// Whether the frames measured along `name` are places of this flight, as far as names and times can show.
bool wasMeasured(const Flight& flight, const QString& name, const harness::Results& results) {
  // If two files have one name, the results name the second one by its path.
  const QString stem = name.contains(QLatin1Char('/')) ? QFileInfo(name).completeBaseName() : name;
  if (stem != stemOf(flight) && stem != plainName(stemOf(flight))) return false;
  const double begin = flight.beginS(), end = begin + flight.durationS();
  for (const harness::Unit& unit : results.units) {
    if (QString::fromStdString(unit.name.flight) != name) continue;
    for (const harness::MeasuredFrame& frame : unit.frames)
      if (frame.timeS < begin - kSameTimeS || frame.timeS > end + kSameTimeS) return false;
  }
  return true;
}

}  // namespace

ErrorsController::ErrorsController(const Workplace& workplace, DrawThread& measuring,
                                   const Neighbours& neighbours)
    : at_(workplace), measuring_(measuring), by_(neighbours) {
  const auto live = [this]() -> std::optional<LiveMeter::Frame> {
    if (!by_.frame.shown() || !by_.terrain.database()) return std::nullopt;
    return LiveMeter::Frame{*by_.frame.shown(), {shownBefore_.begin(), shownBefore_.end()}};
  };
  dock_ = new ErrorDock(at_.draft, measuring_, live,
                        [this](const QString& folder) { return benchInputs(folder); });
  connect(dock_, &ErrorDock::refused, &at_.messages, &MessagePanel::add);
  connect(dock_, &ErrorDock::flipChanged, &by_.frame, &FrameController::setMeasuredFlip);
  connect(dock_, &ErrorDock::sought, this, &ErrorsController::seekFlight);
  connect(dock_, &ErrorDock::flightShown, this, &ErrorsController::followFlight);
  connect(dock_, &ErrorDock::comparisonAsked, this, &ErrorsController::compare);
  connect(dock_, &ErrorDock::flightAsked, &by_.flight, &FlightController::askOpen);
  const auto showMissing = [this] { dock_->setMissing(missing()); };
  connect(&at_.feed, &Feed::flightChanged, dock_, showMissing);
  connect(&by_.terrain, &TerrainController::opened, dock_, showMissing);
  connect(&by_.trace, &TraceController::recordingChanged, dock_, showMissing);
  showMissing();
  connect(&measuring_, &DrawThread::failed, this, [this](const Findings& findings) {
    at_.messages.add(tr("Errors cannot be measured live"), findings);
    dock_->liveSwitch().setChecked(false);
    dock_->liveSwitch().setEnabled(false);
  });
  connect(&at_.feed, &Feed::flightChanged, this, &ErrorsController::followFlight);
  connect(&by_.terrain, &TerrainController::opened, this, &ErrorsController::onTerrainOpened);
  connect(&by_.frame, &FrameController::replaced, this, &ErrorsController::remember);
  connect(&by_.frame, &FrameController::painted, this, &ErrorsController::onPainted);
  const auto source = [this]() -> std::optional<SplitView::Frame> {
    if (!by_.frame.shown() || !by_.frame.session().hasState()) return std::nullopt;
    return SplitView::Frame{by_.frame.session().input().state, *by_.frame.shown()};
  };
  split_ = new SplitView(measuring_, at_.draft, source, at_.viewport);
  connect(split_, &SplitView::refused, &at_.messages, &MessagePanel::add);
}

void ErrorsController::attach() {
  whenSeen(*dock_, this, [this](bool seen) {
    dock_->setSeen(seen);
    followFlight();
  });
  whenSeen(*split_, split_, [this](bool seen) { split_->setSeen(seen); });
}

void ErrorsController::askOpenResults() {
  raiseDock(*dock_);
  dock_->askOpenResults();
}

void ErrorsController::askAndMeasure() {
  if (const QDockWidget* const dock = dockOf(*dock_); dock != nullptr && dock->isHidden()) emit placeWanted();
  raiseDock(*dock_);
  dock_->askAndMeasure();
}

bool ErrorsController::openResults(const QString& file) {
  const bool opened = dock_->openResults(file);
  if (opened) raiseDock(*dock_);
  return opened;
}

/// Returns what measuring needs and how to get it; empty if nothing is missing.
QString ErrorsController::missing() const {
  if (!by_.terrain.database()) return tr("Measuring needs an open terrain: Ctrl+T opens one.");
  if (at_.feed.playback().loaded() || !by_.trace.recorded().isEmpty()) return {};
  return tr(
      "Measuring needs a flight. Open one, or fly and record a trace (Ctrl+R), which is then measured.");
}

/// Without an open flight, the trace that was recorded last is measured.
std::optional<ErrorDock::Inputs> ErrorsController::benchInputs(const QString& folder) {
  const FlightPlayback& playback = at_.feed.playback();
  if (!playback.loaded() && !by_.trace.recorded().isEmpty()) by_.flight.open(by_.trace.recorded());
  if (!by_.terrain.database() || !playback.loaded()) {
    at_.messages.add(tr("Presets cannot be measured"),
                     {{Severity::error,
                       "Run time against error",
                       {},
                       "an open terrain, and a flight or a recorded trace",
                       by_.terrain.database() ? "no flight" : "no terrain"}});
    return std::nullopt;
  }
  const std::optional<ExperimentInputs> files = by_.inputs.write(folder);
  if (!files) return std::nullopt;
  const QString flight = stemOf(playback.flight());
  const bool ours = files->flight.startsWith(folder + QLatin1Char('/'));
  return ErrorDock::Inputs{files->terrain,
                           ours && !flight.isEmpty() ? renamed(files->flight, flight) : files->flight,
                           renamed(files->preset, BenchChoice::kDraft)};
}

void ErrorsController::remember(const FrameRequest& before) {
  if (!dock_->live().isOn()) return shownBefore_.clear();
  shownBefore_.push_back(before);
  if (shownBefore_.size() > kRemembered) shownBefore_.pop_front();
}

void ErrorsController::onPainted() {
  if (by_.frame.counts()) dock_->painted(by_.frame.clock(), by_.frame.lastCost().total);
  split_->painted();
  followFlight();
}

void ErrorsController::onTerrainOpened() {
  measuring_.setTerrain(by_.terrain.database());
  dock_->restartLive();
  split_->setTerrain(by_.terrain.database());
}

void ErrorsController::followFlight() {
  const FlightPlayback& playback = at_.feed.playback();
  const bool flies =
      playback.loaded() && at_.feed.source() != Feed::Source::camera && whyNotMeasured().isEmpty();
  dock_->followFlight(flies ? playback.flight().states.front().time + by_.flight.flightDock().position()
                            : std::numeric_limits<double>::quiet_NaN());
}

/// Returns why the times in the results are not those of the open flight; empty if they are.
QString ErrorsController::whyNotMeasured() const {
  const FlightPlayback& playback = at_.feed.playback();
  if (!dock_->results()) return {};
  const QString measured = dock_->flight();
  if (!playback.loaded()) return tr("Open the flight %1 to see the frames that were measured").arg(measured);
  if (wasMeasured(playback.flight(), measured, *dock_->results())) return {};
  return tr("The results were measured along the flight %1, but the flight %2 is open: open the one that was "
            "measured to see its frames")
      .arg(measured, QString::fromStdString(playback.flight().name));
}

void ErrorsController::seekFlight(double timeS) {
  const FlightPlayback& playback = at_.feed.playback();
  if (const QString why = whyNotMeasured(); !why.isEmpty()) {
    emit hint(why);
    // Dragging the cursor seeks many times a second: one message is enough.
    if (why != hinted_) at_.messages.note(why);
    hinted_ = why;
    return;
  }
  hinted_.clear();
  if (playback.loaded()) by_.flight.flightDock().seek(timeS - playback.flight().states.front().time);
}

void ErrorsController::compare() {
  QDockWidget* const dock = dockOf(*split_);
  if (!isInFront(*split_)) {
    broughtToFront_ = true;
    compareWasHidden_ = dock->isHidden();
    dock->show();
    if (const auto* window = qobject_cast<QMainWindow*>(dock->parentWidget()))
      for (QDockWidget* other : window->tabifiedDockWidgets(dock))
        if (isInFront(*other)) coveredByCompare_ = other;
  }
  raiseDock(*split_);
  split_->setOverViewport(true);
}

void ErrorsController::compareWith(const QString& preset) {
  if (split_->choose(SplitView::right, preset)) compare();
}

void ErrorsController::endComparison() {
  split_->setOverViewport(false);
  // A person who went to another dock or page meanwhile has arranged the docks by hand.
  if (!broughtToFront_ || !isInFront(*split_)) return;
  broughtToFront_ = false;
  raiseDock(*dock_);
  if (coveredByCompare_) coveredByCompare_->raise();
  if (compareWasHidden_) dockOf(*split_)->hide();
  coveredByCompare_.clear();
}

}  // namespace trimtab::workbench
