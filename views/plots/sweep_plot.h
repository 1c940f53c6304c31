// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QStringList>
#include <QVector>

#include "plot.h"

namespace trimtab::views {

/// What was measured at each value of one parameter.
struct SweepLine {
  QString parameter;         ///< the axis's title
  QStringList values;        ///< equally far apart on the axis, in this order
  QVector<double> ms, flip;  ///< by value; NaN where nothing was measured
  double budgetMs = 0;
  qsizetype best = -1;  ///< the value that is marked; none if it is negative
};

/// Frame time and error over the values of one parameter, each on an axis of its own, with the budget as a
/// line.
class SweepPlot : public Plot {
  Q_OBJECT

 public:
  explicit SweepPlot(QWidget* parent = nullptr);
  void show(const SweepLine& line);
  const QCPGraph& times() const { return *ms_; }
  const QCPGraph& errors() const { return *flip_; }

 protected:
  void restyle() override;
  void resized() override { arrangeLegendAbove(); }

 private:
  QCPGraph *ms_, *flip_, *budget_, *best_;
};

}  // namespace trimtab::views
