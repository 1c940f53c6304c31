// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "clock_plot.h"
#include "views/model/recorded_run.h"

namespace trimtab::views {

/// Shows the last seconds in three plots: the predicted time of each image by stage, stacked, with its 90 %
/// band and what would be drawn without the arbiter; the measured time by stage on the same scale, with a
/// recorded run laid over it; and by how much the predictions that came due were off. They are beside each
/// other where there is the width for that, else below each other.
class BudgetPlot : public ClockPlot {
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

  /// The graphs of one kind of time, by stage: running sums, from the bottom.
  using Stack = std::array<QCPGraph*, 4>;
  const Stack& predicted() const { return predicted_; }
  const Stack& measured() const { return measured_; }
  const QCPGraph& recorded() const { return *recorded_; }
  /// The share, percent, by which predictions were too long; they were made three images before.
  const QCPGraph& off() const { return *off_; }

  QSize sizeHint() const override { return {320, minimumSizeHint().height() + 50}; }
  QSize minimumSizeHint() const override;

 protected:
  void restyle() override;
  void resized() override;

 private:
  enum Part : std::size_t { predictedPart, measuredPart, offPart, kParts };
  void makeParts();
  Stack makeStack(Part part);
  QCPGraph* makeLine(Part part, const QString& name = {});
  void arrangeParts();
  void addStack(const Stack& stack, double time, const StageTimes& times, bool known);

  std::array<QCPAxisRect*, kParts> parts_{};
  QCPLayoutGrid* grid_ = nullptr;
  bool wide_ = false;
  Stack predicted_{}, measured_{};
  QCPGraph *total_, *asked_, *bandLow_, *bandHigh_, *budget_, *recorded_, *measuredBudget_;
  QCPGraph *off_, *offLow_, *offHigh_, *none_;
  double begin_ = 0, last_ = 0;  ///< when the plot began, and the newest image
};

}  // namespace trimtab::views
