// SPDX-License-Identifier: GPL-3.0-or-later
#include "report_plot.h"

#include <qcustomplot.h>

#include <QEvent>
#include <QVBoxLayout>
#include <algorithm>
#include <cmath>

#include "views/model/theme.h"

namespace trimtab::views {
namespace {

constexpr double kHeadRoom = 1.08;
/// So few points are marked one by one.
constexpr qsizetype kMarkedPoints = 24;

}  // namespace

ReportPlot::ReportPlot(QWidget* parent) : QWidget(parent), plot_(new QCustomPlot(this)) {
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->addWidget(plot_);
  plot_->setMinimumHeight(100);
  plot_->setInteractions(QCP::iRangeDrag | QCP::iRangeZoom);
  plot_->setAccessibleName(tr("Plot of the experiment"));
  auto* legend = new QCPLegend;
  plot_->plotLayout()->insertRow(0);
  plot_->plotLayout()->addElement(0, 0, legend);
  legend->setFillOrder(QCPLegend::foColumnsFirst);
  legend->setWrap(2);
  plot_->plotLayout()->setRowStretchFactor(0, 0.001);
  plot_->legend = legend;
  clear();
}

void ReportPlot::clear() {
  show({});
}

void ReportPlot::show(const ReportPlotData& report) {
  data_ = report;
  plot_->clearPlottables();
  plot_->xAxis->setLabel(data_.xLabel);
  plot_->yAxis->setLabel(data_.yLabel);
  plot_->setToolTip(data_.title);
  plot_->xAxis->setTicker(QSharedPointer<QCPAxisTicker>::create());
  if (data_.categories.isEmpty())
    addLines();
  else
    addBars();
  applyTheme(*plot_);
  plot_->legend->setVisible(!data_.series.isEmpty());
  plot_->replot(QCustomPlot::rpQueuedReplot);
}

void ReportPlot::addLines() {
  for (int i = 0; i < data_.series.size(); ++i) {
    const ReportPlotData::Series& s = data_.series[i];
    QCPGraph* graph = plot_->addGraph();
    graph->setName(s.name);
    graph->setData(s.x, s.y);
    const QColor colour = seriesColour(i, palette());
    graph->setPen(QPen(colour, 1.5));
    if (s.x.size() <= kMarkedPoints)
      graph->setScatterStyle(QCPScatterStyle(
          static_cast<QCPScatterStyle::ScatterShape>(QCPScatterStyle::ssCircle + i % 6), colour, 7));
  }
  plot_->rescaleAxes();
  plot_->yAxis->setRange(std::min(0.0, plot_->yAxis->range().lower), plot_->yAxis->range().upper * kHeadRoom);
}

void ReportPlot::addBars() {
  auto names = QSharedPointer<QCPAxisTickerText>::create();
  for (int i = 0; i < data_.categories.size(); ++i)
    names->addTick(i + 1, QString(data_.categories[i]).replace(QLatin1Char(' '), QLatin1Char('\n')));
  plot_->xAxis->setTicker(names);
  auto* group = new QCPBarsGroup(plot_);
  double largest = 0;
  for (int i = 0; i < data_.series.size(); ++i) {
    const ReportPlotData::Series& s = data_.series[i];
    auto* bars = new QCPBars(plot_->xAxis, plot_->yAxis);
    bars->setName(s.name);
    bars->setBarsGroup(group);
    bars->setWidth(0.8 / double(data_.series.size()));
    const QColor colour = seriesColour(i, palette());
    bars->setPen(QPen(colour));
    bars->setBrush(blend(palette().color(QPalette::Base), colour, 0.75));
    for (int k = 0; k < s.y.size(); ++k) {
      if (!std::isfinite(s.y[k])) continue;
      bars->addData(k + 1, s.y[k]);
      largest = std::max(largest, s.y[k]);
    }
  }
  plot_->xAxis->setRange(0.4, double(data_.categories.size()) + 0.6);
  plot_->yAxis->setRange(0, largest > 0 ? largest * kHeadRoom : 1);
}

void ReportPlot::changeEvent(QEvent* event) {
  QWidget::changeEvent(event);
  if (event->type() == QEvent::PaletteChange) show(data_);
}

}  // namespace trimtab::views
