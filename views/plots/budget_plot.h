// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "plot.h"
#include "views/model/recorded_run.h"

namespace trimtab::views {

/// Shows the last seconds: the predicted time of each image by stage, stacked, with its 90 % band, beside the
/// measured time, what would be drawn without the arbiter, and the budget.
class BudgetPlot : public Plot {
  Q_OBJECT
 public:
  static constexpr double kSpanS = 15;

  explicit BudgetPlot(QWidget* parent = nullptr);
  /// Adds an image; predictions are shown only while its budget is held. A clock that goes back empties the
  /// plot.
  void append(const LiveFrame& frame, double budgetMs);
  /// Lays the times of a recorded run over those of the images from `atS` on, on the clock of the frames.
  void overlay(const RecordedRun& run, double atS);
  void refresh();

  QSize sizeHint() const override { return {320, 230}; }
  QSize minimumSizeHint() const override { return {240, 150}; }

 protected:
  void restyle() override;
  void resized() override { arrangeLegendAbove(); }

 private:
  std::array<QCPGraph*, 4> stages_{};  ///< running sums, from the bottom
  QCPGraph *measured_, *asked_, *bandLow_, *bandHigh_, *budget_, *recorded_;
  double last_ = 0;
};

}  // namespace trimtab::views
