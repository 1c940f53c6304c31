// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QWidget>

#include "trimtab/hold/frame_hold.h"
#include "trimtab/measure/machine_watch.h"
#include "trimtab/measure/statistics.h"
#include "views/controls/reason_list.h"
#include "views/model/draft.h"
#include "views/model/recorded_run.h"
#include "views/model/throttle.h"

class QComboBox;
class QLabel;
class QPushButton;
class QTableWidget;

namespace trimtab::views {

class BudgetPlot;

/// The Budget dock: what the arbiter predicts and what images take, how much each lever was changed, and how
/// exact the predictions are. What was flown while a trace was recorded is flown again with other settings,
/// to compare.
class BudgetPanel : public QWidget {
  Q_OBJECT
 public:
  explicit BudgetPanel(Draft& draft, QWidget* parent = nullptr);

  /// Shows a frame whose image was drawn. Frames between images change nothing.
  void showFrame(const LiveFrame& frame);
  /// Begins a new run with what is flown from now on, or ends it. A run is RecordedRun::kLongestS at most.
  void setRecording(bool on);

  QString stateText() const;
  /// Returns how the limit of predictions follows from the budget.
  QString limitText() const;
  QString residualsText() const;
  QString comparisonText() const;
  QPushButton& replayButton() { return *replay_; }
  /// Chooses what flies again: the preset as it is, or with policy and budget switched.
  QComboBox& modeChoice() { return *mode_; }
  QTableWidget& levers() { return *levers_; }
  QListWidget& reasons() { return *reasons_; }
  BudgetPlot& plot() { return *plot_; }

 signals:
  /// These states are to be flown again, with the preset as it is now.
  void replayAsked(const std::vector<trimtab::AircraftState>& states);

 private:
  static constexpr std::size_t kOutcomes = 300;

  QLayout* makeRecorder();
  void askReplay();
  void addToRun(const LiveFrame& frame);
  void compare();
  void refresh();
  void count(const HoldOutcome& outcome);
  void note(const LiveFrame& frame);
  void refreshLevers();
  void refreshLimit();
  void switchTo(int mode);

  Draft& draft_;
  QLabel *state_, *limit_, *residuals_, *comparison_, *busy_;
  BudgetPlot* plot_;
  QPushButton* replay_;
  QTableWidget* levers_;
  ReasonList* reasons_;
  QComboBox* mode_;
  HoldDecision shown_;
  std::optional<LeverChain> chain_;  ///< of the image shown
  HoldGains gains_;
  HoldReason noted_ = HoldReason::off;
  /// These samples are of predictions that came due: how far off they were, as a share, and 1 if the measured
  /// time was within the band.
  SampleWindow trianglesOff_{kOutcomes}, timeOff_{kOutcomes}, within_{kOutcomes};
  bool recording_ = false;
  RecordedRun recorded_, replayed_;
  MachineWatch watch_;              ///< since the recording began
  std::size_t comparedImages_ = 0;  ///< the images of both runs that the comparison counts
  /// The state of the replay: there is none, it was asked for and has no image yet, or it is flown.
  enum class Replay { none, asked, flies } stage_ = Replay::none;
  Throttle throttle_;
};

}  // namespace trimtab::views
