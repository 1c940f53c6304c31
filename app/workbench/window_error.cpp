// SPDX-License-Identifier: GPL-3.0-or-later
#include <QDockWidget>
#include <QFile>
#include <QFileInfo>
#include <QRegularExpression>
#include <limits>

#include "error_dock.h"
#include "experiments_dock.h"
#include "flight_dock.h"
#include "main_window.h"
#include "split_view.h"

// Run time against error: what is measured, over what, and where the flight goes.
namespace trimtab::workbench {
namespace {

/// A blur of longer than so many pictures mixes nothing more that shows.
constexpr std::size_t kRemembered = 16;

/// Whose stem names it in the results.
QString renamed(const QString& file, const QString& stem) {
  QString plain = stem;
  plain.replace(QRegularExpression(QStringLiteral("[^A-Za-z0-9._-]+")), QStringLiteral("-"));
  const QFileInfo info(file);
  const QString to = QStringLiteral("%1/%2.%3").arg(info.path(), plain, info.suffix());
  if (to == file) return file;
  QFile::remove(to);
  return QFile::rename(file, to) ? to : file;
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
    const QString flight =
        QFileInfo(QString::fromStdString(feed_.playback().flight().name)).completeBaseName();
    return ErrorDock::Inputs{files->terrain,
                             flight.isEmpty() ? files->flight : renamed(files->flight, flight),
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
  const bool flies = playback.loaded() && feed_.source() != Feed::Source::camera;
  errors_->followFlight(flies ? playback.flight().states.front().time + flightDock_->position()
                              : std::numeric_limits<double>::quiet_NaN());
}

void MainWindow::seekFlight(double timeS) {
  const FlightPlayback& playback = feed_.playback();
  if (!playback.loaded())
    return messages_->note(tr("Open the flight that was measured, and its frames can be seen"));
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
