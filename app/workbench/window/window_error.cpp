// SPDX-License-Identifier: GPL-3.0-or-later
#include <QDockWidget>
#include <QFile>
#include <QFileInfo>
#include <QRegularExpression>
#include <QStatusBar>
#include <limits>

#include "app/workbench/docks/error_dock.h"
#include "app/workbench/docks/experiments_dock.h"
#include "app/workbench/docks/flight_dock.h"
#include "app/workbench/viewport/split_view.h"
#include "main_window.h"

// Run time against error: what is measured, over what, and where the flight goes.
namespace trimtab::workbench {
namespace {

/// A blur of longer than so many pictures mixes nothing more that shows.
constexpr std::size_t kRemembered = 16;
constexpr int kSayMs = 8000;
constexpr double kSameTimeS = 1e-6;

QString plainName(QString name) {
  return name.replace(QRegularExpression(QStringLiteral("[^A-Za-z0-9._-]+")), QStringLiteral("-"));
}

/// Whose stem names it in the results.
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

/// Whether the frames measured along `name` are places of this flight, as far as names and times can tell.
bool wasMeasured(const Flight& flight, const QString& name, const harness::Results& results) {
  // Of two files of one name the second is named by its path.
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

ErrorDock* MainWindow::makeErrorDock() {
  const auto live = [this]() -> std::optional<LiveMeter::Frame> {
    if (!shown_ || !terrain_) return std::nullopt;
    return LiveMeter::Frame{*shown_, {shownBefore_.begin(), shownBefore_.end()}};
  };
  const auto inputs = [this](const QString& folder) -> std::optional<ErrorDock::Inputs> {
    if (!feed_.playback().loaded() && !recordedTrace_.isEmpty()) openFlight(recordedTrace_);
    if (!terrain_ || !feed_.playback().loaded()) {
      messages_->add(tr("Presets cannot be measured"), {{Severity::error,
                                                         "Run time against error",
                                                         {},
                                                         "an open terrain, and a flight or a recorded trace",
                                                         terrain_ ? "no flight" : "no terrain"}});
      return std::nullopt;
    }
    const std::optional<ExperimentInputs> files = experimentInputs(folder);
    if (!files) return std::nullopt;
    const QString flight = stemOf(feed_.playback().flight());
    const bool ours = files->flight.startsWith(folder + QLatin1Char('/'));
    return ErrorDock::Inputs{files->terrain,
                             ours && !flight.isEmpty() ? renamed(files->flight, flight) : files->flight,
                             renamed(files->preset, BenchChoice::kDraft)};
  };
  return new ErrorDock(draft_, measuring_, live, inputs);
}

void MainWindow::connectErrors() {
  const auto refused = [this](const QString& what, const Findings& findings) {
    messages_->add(what, findings);
  };
  connect(errors_, &ErrorDock::refused, this, refused);
  connect(errors_, &ErrorDock::sought, this, &MainWindow::seekFlight);
  connect(errors_, &ErrorDock::flightShown, this, &MainWindow::followFlight);
  connect(errors_, &ErrorDock::comparisonAsked, this, &MainWindow::showSplitView);
  connect(dock(QStringLiteral("errors")), &QDockWidget::visibilityChanged, errors_, [this](bool seen) {
    errors_->setSeen(seen);
    followFlight();
  });
  connect(&measuring_, &DrawThread::failed, this, [this, refused](const Findings& findings) {
    refused(tr("Errors cannot be measured live"), findings);
    errors_->liveSwitch().setChecked(false);
    errors_->liveSwitch().setEnabled(false);
  });
  connect(&feed_, &Feed::flightChanged, this, &MainWindow::followFlight);
}

void MainWindow::raiseErrors() {
  QDockWidget* const dock = this->dock(QStringLiteral("errors"));
  dock->show();
  dock->raise();
}

void MainWindow::rememberShown() {
  if (!errors_->live().isOn()) return shownBefore_.clear();
  if (!shown_) return;
  shownBefore_.push_back(std::move(*shown_));
  if (shownBefore_.size() > kRemembered) shownBefore_.pop_front();
}

void MainWindow::followErrors() {
  if (shown_ && viewport_->lastResult())
    errors_->painted(double(sinceStart_.nsecsElapsed()) * 1e-9, lastCost_.total);
  if (split_ != nullptr) split_->painted();
  followFlight();
}

void MainWindow::followFlight() {
  const FlightPlayback& playback = feed_.playback();
  const bool flies =
      playback.loaded() && feed_.source() != Feed::Source::camera && whyNotMeasured().isEmpty();
  errors_->followFlight(flies ? playback.flight().states.front().time + flightDock_->position()
                              : std::numeric_limits<double>::quiet_NaN());
}

/// Why the times of the results are not the open flight's; empty: they are.
QString MainWindow::whyNotMeasured() {
  const FlightPlayback& playback = feed_.playback();
  if (!errors_->results()) return {};
  const QString measured = errors_->flight();
  if (!playback.loaded()) return tr("Open the flight %1 to see the frames that were measured").arg(measured);
  if (wasMeasured(playback.flight(), measured, *errors_->results())) return {};
  return tr("The results are of the flight %1, and %2 is open, which is another: open the one that was "
            "measured to see its frames")
      .arg(measured, QString::fromStdString(playback.flight().name));
}

void MainWindow::seekFlight(double timeS) {
  const FlightPlayback& playback = feed_.playback();
  if (const QString why = whyNotMeasured(); !why.isEmpty()) {
    statusBar()->showMessage(why, kSayMs);
    // A hand on the cursor seeks many times a second.
    if (why != saidOfFlight_) messages_->note(why);
    saidOfFlight_ = why;
    return;
  }
  saidOfFlight_.clear();
  if (!playback.loaded()) return;
  flightDock_->seek(timeS - playback.flight().states.front().time);
}

void MainWindow::showSplitView() {
  if (split_ == nullptr) {
    const auto source = [this]() -> std::optional<SplitView::Frame> {
      if (!shown_ || !feed_.session().hasState()) return std::nullopt;
      return SplitView::Frame{feed_.session().input().state, *shown_};
    };
    split_ = new SplitView(measuring_, draft_, source, this);
    split_->setTerrain(terrain_);
    connect(split_, &SplitView::refused, this,
            [this](const QString& what, const Findings& findings) { messages_->add(what, findings); });
  }
  split_->show();
  split_->raise();
  split_->activateWindow();
}

}  // namespace trimtab::workbench
