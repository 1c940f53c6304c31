// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QString>
#include <QStringList>
#include <QVector>
#include <QWidget>

class QCustomPlot;

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
class ReportPlot : public QWidget {
  Q_OBJECT
 public:
  explicit ReportPlot(QWidget* parent = nullptr);
  void show(const ReportPlotData& report);
  void clear();
  QCustomPlot& plot() { return *plot_; }

 protected:
  void changeEvent(QEvent* event) override;

 private:
  void addLines();
  void addBars();

  QCustomPlot* plot_;
  ReportPlotData data_;
};

}  // namespace trimtab::views
