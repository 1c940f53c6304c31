// SPDX-License-Identifier: GPL-3.0-or-later
#include "sweep_plot.h"

#include <algorithm>
#include <cmath>

#include "views/model/theme.h"

namespace trimtab::views {
namespace {

constexpr double kAbove = 1.15;

double largestOf(const QVector<double>& values, double least) {
  double largest = least;
  for (const double value : values)
    if (std::isfinite(value)) largest = std::max(largest, value);
  return largest;
}

}  // namespace

SweepPlot::SweepPlot(QWidget* parent)
    : Plot(tr("Frame time and error over a parameter"), Keyboard::ignored, parent) {
  setMinimumSize(240, 140);
  addLegendAbove();
  xAxis->setSubTicks(false);
  yAxis->setLabel(tr("p95 (ms)"));
  yAxis2->setLabel(tr("FLIP"));
  yAxis2->setVisible(true);
  const auto add = [this](QCPAxis* axis, const QString& name, QCPScatterStyle::ScatterShape shape) {
    QCPGraph* graph = addGraph(xAxis, axis);
    graph->setName(name);
    graph->setScatterStyle(QCPScatterStyle(shape, 7));
    graph->addToLegend(legend);
    return graph;
  };
  ms_ = add(yAxis, tr("p95 of the frame time"), QCPScatterStyle::ssDisc);
  flip_ = add(yAxis2, tr("FLIP"), QCPScatterStyle::ssTriangle);
  budget_ = add(yAxis, tr("budget"), QCPScatterStyle::ssNone);
  best_ = add(yAxis, tr("best that fits"), QCPScatterStyle::ssStar);
  best_->setLineStyle(QCPGraph::lsNone);
  restyle();
}

void SweepPlot::show(const SweepLine& line) {
  QVector<double> places;
  const QSharedPointer<QCPAxisTickerText> ticks(new QCPAxisTickerText);
  for (qsizetype i = 0; i < line.values.size(); ++i) {
    places.append(double(i));
    ticks->addTick(double(i), line.values[i]);
  }
  xAxis->setTicker(ticks);
  xAxis->setLabel(line.parameter);
  const double end = double(line.values.size()) - 0.5;
  xAxis->setRange(-0.5, end);
  ms_->setData(places, line.ms, true);
  flip_->setData(places, line.flip, true);
  budget_->setData({-0.5, end}, {line.budgetMs, line.budgetMs}, true);
  if (line.best >= 0 && line.best < line.ms.size())
    best_->setData({double(line.best)}, {line.ms[line.best]});
  else
    best_->setData(QVector<double>{}, QVector<double>{});
  yAxis->setRange(0, largestOf(line.ms, line.budgetMs) * kAbove);
  yAxis2->setRange(0, largestOf(line.flip, 1e-4) * kAbove);
  replot(QCustomPlot::rpQueuedReplot);
}

void SweepPlot::restyle() {
  applyThemeWithLegendAbove();
  ms_->setPen(QPen(seriesColour(0, palette()), 1.5));
  flip_->setPen(QPen(seriesColour(1, palette()), 1.5, Qt::DashLine));
  budget_->setPen(QPen(errorColour(palette()), 1.5, Qt::DotLine));
  best_->setPen(QPen(seriesColour(2, palette()), 2));
  best_->setScatterStyle(QCPScatterStyle(QCPScatterStyle::ssStar, 15));
  arrangeLegendAbove();
  replot(QCustomPlot::rpQueuedReplot);
}

}  // namespace trimtab::views
