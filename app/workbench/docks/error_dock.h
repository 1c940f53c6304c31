// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QTemporaryDir>
#include <QWidget>
#include <functional>
#include <optional>

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

namespace trimtab::workbench {

/// Run time against error: the presets as a benchmark measured them and the live session among them, and the
/// frames of the flight along time, whose cursor is the flight's.
class ErrorDock : public QWidget {
  Q_OBJECT

 public:
  /// What a benchmark runs over, as files; what is only in memory is written into the folder.
  struct Inputs {
    QString terrain, flight, draft;
  };
  /// None: said already why not.
  using Source = std::function<std::optional<Inputs>(const QString& folder)>;

  ErrorDock(views::Draft& draft, DrawThread& thread, LiveMeter::Source live, Source source,
            QWidget* parent = nullptr);

  /// Whether a person can see it. Qt calls a dock behind other tabs visible.
  void setSeen(bool seen);
  /// The viewport painted a picture; `time` in seconds.
  void painted(double time, double frameMs);
  /// What was live is no longer comparable: another terrain, or a pause.
  void restartLive();
  /// Where the flight stands on its own clock, s; NaN: none flies.
  void followFlight(double timeS);

  void askAndMeasure();
  void measure(const BenchChoice& choice);
  void cancel();
  bool running() const { return child_.running(); }
  void askOpenResults();
  bool openResults(const QString& file);
  const std::optional<harness::Results>& results() const { return results_; }
  /// The measured flight that is drawn; empty: none.
  QString flight() const;
  /// Beside the results; empty: none.
  QString report() const;
  void openReport();

  views::ErrorPlot& plot() { return *plot_; }
  views::ErrorTimeline& timeline() { return *timeline_; }
  LiveMeter& live() { return live_; }
  QCheckBox& liveSwitch() { return *liveOn_; }
  QComboBox& errorChoice() { return *errors_; }
  const std::optional<LiveMeter::Measured>& lastMeasured() const { return lastMeasured_; }
  QString liveText() const;

 signals:
  void finished(bool good);
  void refused(const QString& what, const trimtab::Findings& findings);
  void sought(double timeS);  ///< the person moved the cursor of the flight
  void flightShown();         ///< another measured flight is drawn, or the same of other results
  void comparisonAsked();

 private:
  void arrange();
  void setRunning(bool running);
  void showResults();
  void showBudget();
  void onMeasured(const LiveMeter::Measured& measured);
  void onEnded(const ChildRun::Ended& how);

  views::Draft& draft_;
  Source source_;
  LiveMeter live_;
  ChildRun child_;
  QTemporaryDir folder_;
  QString resultsFile_;  ///< of what is shown, or to be shown once it is measured
  QString measuring_;
  std::optional<harness::Results> results_;
  std::optional<LiveMeter::Measured> lastMeasured_;
  bool seen_ = false;

  QComboBox *errors_, *flights_, *cases_;
  QCheckBox *logarithmic_, *liveOn_;
  QPushButton *measure_, *open_, *report_, *compare_;
  QProgressBar* progress_;
  QLabel *status_, *liveLabel_;
  views::ErrorPlot* plot_;
  views::ErrorTimeline* timeline_;
};

}  // namespace trimtab::workbench
