// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "time_plot.h"

namespace trimtab::views {

/// Draws over one lane what happened beside the frames: a hatched stretch where the host was silent, a bar
/// along the top while a trace was recorded, and a tick at the bottom for each change of the decision.
class TimePlot::Marks : public QCPAbstractItem {
 public:
  /// Only the first lane names a stretch in words.
  Marks(TimePlot& plot, const PlotMarks& marks, QCPAxisRect* lane, bool first);
  double selectTest(const QPointF&, bool, QVariant*) const override { return -1; }

 protected:
  void draw(QCPPainter* painter) override;

 private:
  void drawSpan(QCPPainter* painter, const PlotMarks::Span& span, double from, double to) const;

  const TimePlot& plot_;
  const PlotMarks& marks_;
  QCPAxisRect* lane_;
  bool first_;
};

}  // namespace trimtab::views
