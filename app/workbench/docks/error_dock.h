// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QTemporaryDir>
#include <QWidget>
#include <functional>
#include <optional>
#include <set>

#include "app/harness/results.h"
#include "app/workbench/dialogs/bench_dialog.h"
#include "app/workbench/jobs/child_run.h"
#include "app/workbench/jobs/live_meter.h"
#include "views/model/draft.h"
#include "views/plots/error_plot.h"
#include "views/plots/error_timeline.h"

class QCheckBox;
class QComboBox;
class QLabel;
class QProgressBar;
class QPushButton;
class QTabWidget;

namespace trimtab::workbench {

class AnswerPage;
class SweepPage;

/// Shows run time against error: presets as a benchmark measured them, with the live session among them, and
/// the measured frames along the flight, with a cursor that moves with the flight. A page beside the plots
/// says which preset fits the budget best.
class ErrorDock : public QWidget {
  Q_OBJECT

 public:
  /// The files that a benchmark runs over. What exists only in memory is written into the folder first.
  struct Inputs {
    QString terrain, flight, draft;
  };
  /// Returns nothing if a run is impossible, after reporting why.
  using Source = std::function<std::optional<Inputs>(const QString& folder)>;

  ErrorDock(views::Draft& draft, DrawThread& thread, LiveMeter::Source live, Source source,
            QWidget* parent = nullptr);

  /// Sets whether a person can see it. It cannot find out itself, because Qt calls a dock behind other tabs
  /// visible.
  void setSeen(bool seen);
  /// Measures live although nobody sees this dock, because another one shows the results. Each `who` is
  /// counted on its own.
  void setWatched(const QObject* who, bool watched);
  /// Call this after the viewport has painted. `time` is in seconds.
  void painted(double time, double frameMs);
  /// Forgets what was measured live, because it can no longer be compared: another terrain was opened, or
  /// live measuring paused.
  void restartLive();
  /// Moves the cursor to this time on the flight's own clock, seconds. NaN hides it, because nothing flies.
  void followFlight(double timeS);

  /// Says what measuring needs and does not have; empty if it has all. While something is missing nothing is
  /// asked, and a button offers a flight.
  void setMissing(const QString& what);
  void askAndMeasure();
  void measure(const BenchChoice& choice);
  void cancel();
  const ChildRun& child() const { return child_; }
  bool running() const { return child_.running(); }
  void askOpenResults();
  bool openResults(const QString& file);
  const std::optional<harness::Results>& results() const { return results_; }
  /// Returns the measured flight that is shown; empty if none is.
  QString flight() const;
  /// Returns the report.html beside the results; empty if there is none.
  QString report() const;
  void openReport();

  views::ErrorPlot& plot() { return *plot_; }
  views::ErrorTimeline& timeline() { return *timeline_; }
  AnswerPage& answer() { return *answer_; }
  SweepPage& sweep() { return *sweep_; }
  /// Which page is in front: the answer, the sweep or the plots.
  QTabWidget& pages() { return *pages_; }
  LiveMeter& live() { return live_; }
  QCheckBox& liveSwitch() { return *liveOn_; }
  QComboBox& errorChoice() { return *errors_; }
  const std::optional<LiveMeter::Measured>& lastMeasured() const { return lastMeasured_; }
  QString liveText() const;

 signals:
  void finished(bool good);
  void refused(const QString& what, const trimtab::Findings& findings);
  void sought(double timeS);  ///< the person moved the cursor to this time of the flight
  void flightShown();         ///< another measured flight is shown, or other results of the same
  void comparisonAsked();
  /// FLIP of the image that was measured last; NaN once that is forgotten, or nothing is measured any more.
  void flipChanged(double flip);
  void flightAsked();  ///< the person wants to open one to measure along

 private:
  void arrange();
  void measureIfWanted();
  void setRunning(bool running);
  void showResults();
  void showBudget();
  void showAnswer();
  void onMeasured(const LiveMeter::Measured& measured);
  void onEnded(const ChildRun::Ended& how);

  views::Draft& draft_;
  Source source_;
  LiveMeter live_;
  ChildRun child_;
  QTemporaryDir folder_;
  QString resultsFile_;  ///< what is shown, or will be shown once it is measured
  QString measuring_, missing_;
  std::optional<harness::Results> results_;
  std::optional<LiveMeter::Measured> lastMeasured_;
  bool seen_ = false;
  std::set<const QObject*> watchers_;

  QComboBox *errors_, *flights_, *cases_;
  QCheckBox *logarithmic_, *liveOn_;
  QPushButton *measure_, *open_, *report_, *compare_, *openFlight_;
  QProgressBar* progress_;
  QLabel *status_, *liveLabel_;
  views::ErrorPlot* plot_;
  views::ErrorTimeline* timeline_;
  AnswerPage* answer_;
  SweepPage* sweep_;
  QTabWidget* pages_;
};

}  // namespace trimtab::workbench
