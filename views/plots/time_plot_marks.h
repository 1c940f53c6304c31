// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "time_plot.h"

namespace trimtab::views {

/// What happened beside the frames, over one lane: a hatched stretch where the host was silent, a bar along
/// the top while a trace was recorded, a tick at the foot for each change of the decision.
class TimePlot::Marks : public QCPAbstractItem {
 public:
  /// The first lane says in words what a stretch is.
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
