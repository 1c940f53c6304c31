// SPDX-License-Identifier: GPL-3.0-or-later
#include "report_plot.h"

#include <algorithm>
#include <cmath>

#include "views/model/theme.h"

namespace trimtab::views {
namespace {

constexpr double kReportHeadRoom = 1.08;
/// Lines of at most so many points have a marker at each.
constexpr qsizetype kMarkedPoints = 24;

}  // namespace

ReportPlot::ReportPlot(QWidget* parent)
    : Plot(tr("Plot of the experiment"), Keyboard::ignored, parent), group_(new QCPBarsGroup(this)) {
  setMinimumHeight(100);
  setInteractions(QCP::iRangeDrag | QCP::iRangeZoom);
  addLegendAbove();
  clear();
}

void ReportPlot::clear() {
  show({});
}

void ReportPlot::show(const ReportPlotData& report) {
  data_ = report;
  clearPlottables();
  xAxis->setLabel(data_.xLabel);
  yAxis->setLabel(data_.yLabel);
  setToolTip(data_.title);
  xAxis->setTicker(QSharedPointer<QCPAxisTicker>::create());
  if (data_.categories.isEmpty())
    addLines();
  else
    addBars();
  applyThemeWithLegendAbove();
  arrangeLegendAbove();
  replot(QCustomPlot::rpQueuedReplot);
}

void ReportPlot::addLines() {
  for (int i = 0; i < data_.series.size(); ++i) {
    const ReportPlotData::Series& s = data_.series[i];
    QCPGraph* graph = addGraph();
    graph->setName(s.name);
    graph->addToLegend();
    graph->setData(s.x, s.y);
    const QColor colour = seriesColour(i, palette());
    graph->setPen(QPen(colour, 1.5));
    if (s.x.size() <= kMarkedPoints)
      graph->setScatterStyle(QCPScatterStyle(
          static_cast<QCPScatterStyle::ScatterShape>(QCPScatterStyle::ssCircle + i % 6), colour, 7));
  }
  if (data_.series.isEmpty()) return;
  rescaleAxes();
  const QCPRange values = yAxis->range();
  yAxis->setRange(std::min(0.0, values.lower), std::max(0.0, values.upper) * kReportHeadRoom);
}

void ReportPlot::addBars() {
  auto names = QSharedPointer<QCPAxisTickerText>::create();
  for (int i = 0; i < data_.categories.size(); ++i)
    names->addTick(i + 1, QString(data_.categories[i]).replace(QLatin1Char(' '), QLatin1Char('\n')));
  xAxis->setTicker(names);
  double smallest = 0, largest = 0;
  for (int i = 0; i < data_.series.size(); ++i) {
    const ReportPlotData::Series& s = data_.series[i];
    auto* bars = new QCPBars(xAxis, yAxis);
    bars->setName(s.name);
    bars->addToLegend();
    bars->setBarsGroup(group_);
    bars->setWidth(0.8 / double(data_.series.size()));
    const QColor colour = seriesColour(i, palette());
    bars->setPen(QPen(colour));
    bars->setBrush(blend(palette().color(QPalette::Base), colour, 0.75));
    for (int k = 0; k < s.y.size(); ++k) {
      if (!std::isfinite(s.y[k])) continue;
      bars->addData(k + 1, s.y[k]);
      const bool interval = k < s.low.size() && std::isfinite(s.low[k]) && std::isfinite(s.high[k]);
      largest = std::max(largest, interval ? std::max(s.y[k], s.high[k]) : s.y[k]);
      smallest = std::min(smallest, interval ? std::min(s.y[k], s.low[k]) : s.y[k]);
    }
    if (!s.low.isEmpty()) addIntervals(bars, s);
  }
  xAxis->setRange(0.4, double(data_.categories.size()) + 0.6);
  yAxis->setRange(smallest * kReportHeadRoom, largest > 0 ? largest * kReportHeadRoom : 1);
}

void ReportPlot::addIntervals(QCPBars* bars, const ReportPlotData::Series& series) {
  QVector<double> below, above;
  for (int k = 0; k < series.y.size(); ++k) {
    if (!std::isfinite(series.y[k])) continue;
    const bool known = std::isfinite(series.low[k]) && std::isfinite(series.high[k]);
    below << (known ? series.y[k] - series.low[k] : 0);
    above << (known ? series.high[k] - series.y[k] : 0);
  }
  auto* whiskers = new QCPErrorBars(xAxis, yAxis);
  whiskers->removeFromLegend();
  whiskers->setDataPlottable(bars);
  whiskers->setData(below, above);
  whiskers->setPen(QPen(palette().color(QPalette::Text), 1.5));
}

}  // namespace trimtab::views
