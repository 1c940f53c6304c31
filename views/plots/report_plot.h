// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QString>
#include <QStringList>
#include <QVector>

#include "plot.h"

namespace trimtab::views {

/// What a ReportPlot shows: lines over numbers, or bars side by side over categories. Labels have the units.
struct ReportPlotData {
  struct Series {
    QString name;
    QVector<double> x, y;  ///< NaN breaks a line
    /// Ends of the interval of each bar; empty: none. A pair that is not finite is an interval unknown.
    QVector<double> low{}, high{};
  };
  QString title, xLabel, yLabel;
  QStringList categories;  ///< empty: lines
  QVector<Series> series;
};

/// Shows one plot of a finished report.
class ReportPlot : public Plot {
  Q_OBJECT
 public:
  explicit ReportPlot(QWidget* parent = nullptr);
  void show(const ReportPlotData& report);
  void clear();

 protected:
  void restyle() override { show(data_); }
  void resized() override { arrangeLegendAbove(); }

 private:
  void addLines();
  void addBars();
  /// Adds whiskers to bars, which have one place for each finite value of the series.
  void addIntervals(QCPBars* bars, const ReportPlotData::Series& series);

  ReportPlotData data_;
  QCPBarsGroup* group_;  ///< puts the bars of a category side by side
};

}  // namespace trimtab::views
