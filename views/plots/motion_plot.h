// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "clock_plot.h"
#include "views/model/live.h"

namespace trimtab::views {

/// Shows the last seconds: the rate of the line of sight against its threshold, the LOD scale, and the time
/// that is blurred.
class MotionPlot : public ClockPlot {
  Q_OBJECT
 public:
  static constexpr double kSpanS = 15;

  explicit MotionPlot(QWidget* parent = nullptr);
  /// Adds a frame. A clock that goes back empties the plot.
  void append(const LiveFrame& frame);
  void refresh();

  QSize sizeHint() const override { return {320, 190}; }
  QSize minimumSizeHint() const override { return {220, 120}; }

 protected:
  void restyle() override;
  void resized() override { arrangeLegendAbove(); }

 private:
  QCPGraph *rate_, *threshold_, *scale_, *blur_;
  double last_ = 0;
};

}  // namespace trimtab::views
