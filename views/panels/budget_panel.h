// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QWidget>

#include "trimtab/hold/frame_hold.h"
#include "trimtab/measure/statistics.h"
#include "views/model/draft.h"
#include "views/model/live.h"
#include "views/model/throttle.h"

class QLabel;
class QListWidget;
class QTableWidget;

namespace trimtab::views {

class BudgetPlot;

/// The Budget dock: what the arbiter predicts and what images take, which lever gave what, and how the
/// predictions come out.
class BudgetPanel : public QWidget {
  Q_OBJECT
 public:
  explicit BudgetPanel(Draft& draft, QWidget* parent = nullptr);

  /// Shows a frame whose image was drawn. Frames between images change nothing.
  void showFrame(const LiveFrame& frame);

  QString stateText() const;
  QString residualsText() const;
  QTableWidget& levers() { return *levers_; }
  QListWidget& reasons() { return *reasons_; }
  BudgetPlot& plot() { return *plot_; }

 private:
  static constexpr std::size_t kOutcomes = 300;

  void refresh();
  void count(const HoldOutcome& outcome);
  void note(const LiveFrame& frame);

  Draft& draft_;
  QLabel *state_, *residuals_;
  BudgetPlot* plot_;
  QTableWidget* levers_;
  QListWidget* reasons_;
  HoldDecision shown_;
  HoldReason noted_ = HoldReason::off;
  /// Of the predictions that came due: how far off they were, as a part, and 1 where the band held.
  SampleWindow trianglesOff_{kOutcomes}, timeOff_{kOutcomes}, within_{kOutcomes};
  Throttle throttle_;
};

}  // namespace trimtab::views
