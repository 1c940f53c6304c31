// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QString>
#include <QStringList>
#include <QVector>

#include "plot.h"

namespace trimtab::views {

/// Lines over numbers, or bars side by side over categories; labels carry the units.
struct ReportPlotData {
  struct Series {
    QString name;
    QVector<double> x, y;  ///< NaN breaks a line
  };
  QString title, xLabel, yLabel;
  QStringList categories;  ///< empty: lines
  QVector<Series> series;
};

/// One plot of a report that is finished: nothing in it moves.
class ReportPlot : public Plot {
  Q_OBJECT
 public:
  explicit ReportPlot(QWidget* parent = nullptr);
  void show(const ReportPlotData& report);
  void clear();

 protected:
  void restyle() override { show(data_); }

 private:
  void addLines();
  void addBars();

  ReportPlotData data_;
};

}  // namespace trimtab::views
