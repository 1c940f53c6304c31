// SPDX-License-Identifier: GPL-3.0-or-later
#include "budget_plot.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "trimtab/hold/cost_model.h"
#include "views/model/theme.h"

namespace trimtab::views {

BudgetPlot::BudgetPlot(QWidget* parent)
    : Plot(tr("Predicted and measured frame time"), Keyboard::ignored, parent) {
  setPlottingHints(QCP::phFastPolylines | QCP::phCacheLabels);
  setNotAntialiasedElements(QCP::aeAxes | QCP::aeGrid | QCP::aeFills);
  addLegendAbove();
  xAxis->setLabel(tr("Time (s)"));
  yAxis->setLabel(tr("Work time (ms)"));
  xAxis->setNumberFormat(QStringLiteral("g"));
  for (QCPAxis* axis : {xAxis, yAxis}) {
    axis->setSubTicks(false);
    axis->ticker()->setTickCount(4);
  }
  const std::array<QString, 4> names{tr("ground"), tr("weather"), tr("blur"), tr("other")};
  for (std::size_t i = 0; i < stages_.size(); ++i) {
    stages_[i] = addGraph();
    stages_[i]->setName(names[i]);
  }
  const auto line = [this](const QString& name) {
    QCPGraph* graph = addGraph();
    graph->setName(name);
    return graph;
  };
  bandLow_ = line(QString());
  bandHigh_ = line(tr("90 % band"));
  bandHigh_->setChannelFillGraph(bandLow_);
  asked_ = line(tr("as asked"));
  budget_ = line(tr("budget"));
  recorded_ = line(tr("recorded"));
  measured_ = line(tr("measured"));
  for (QCPGraph* graph : {measured_, recorded_, budget_, asked_, bandHigh_}) graph->addToLegend(legend);
  for (QCPGraph* graph : stages_) graph->addToLegend(legend);
  restyle();
}

void BudgetPlot::append(const LiveFrame& frame, double budgetMs) {
  const HoldDecision& hold = frame.hold;
  const double time = frame.time;
  if (time < last_)
    for (int i = 0; i < graphCount(); ++i) graph(i)->data()->clear();
  last_ = time;
  // A value that is not a number is a gap.
  const bool predicted = hold.reason != HoldReason::off && hold.heldMs.total() > 0;
  const auto orGap = [predicted](double ms) {
    return predicted ? ms : std::numeric_limits<double>::quiet_NaN();
  };
  double sum = 0;
  const StageTimes& s = hold.heldMs;
  const std::array<double, 4> stages{s.ground, s.weather, s.blur, s.other};
  for (std::size_t i = 0; i < stages.size(); ++i) stages_[i]->addData(time, orGap(sum += stages[i]));
  bandLow_->addData(time, orGap(std::max(s.total() - hold.bandMs, 0.0)));
  bandHigh_->addData(time, orGap(s.total() + hold.bandMs));
  asked_->addData(time, orGap(hold.askedMs.total()));
  budget_->addData(time, budgetMs);
  measured_->addData(time, workMs(frame.cost));
  for (int i = 0; i < graphCount(); ++i) graph(i)->data()->removeBefore(time - kSpanS);
}

void BudgetPlot::overlay(const RecordedRun& run, double atS) {
  recorded_->data()->clear();
  for (std::size_t i = 0; i < run.images(); ++i)
    recorded_->addData(atS + run.states()[i].time - run.states()[0].time, run.ms()[i]);
}

void BudgetPlot::refresh() {
  double top = 1;
  std::vector<double> times;
  for (const QCPGraph* graph : {asked_, measured_, recorded_, budget_}) {
    times.clear();
    for (const QCPGraphData& point : *graph->data())
      if (std::isfinite(point.value)) times.push_back(point.value);
    if (times.empty()) continue;
    // A spike does not flatten the plot: one image in fifty may leave it.
    const auto most = times.begin() + std::ptrdiff_t(double(times.size() - 1) * 0.98);
    std::nth_element(times.begin(), most, times.end());
    top = std::max(top, *most);
  }
  xAxis->setRange(last_ - kSpanS, last_);
  yAxis->setRange(0, top * 1.15);
  replot(QCustomPlot::rpQueuedReplot);
}

void BudgetPlot::restyle() {
  applyThemeWithLegendAbove();
  for (std::size_t i = 0; i < stages_.size(); ++i) {
    QColor fill = seriesColour(int(i) + 1, palette());
    stages_[i]->setPen(QPen(fill, 1));
    fill.setAlpha(70);
    stages_[i]->setBrush(fill);
    if (i > 0) stages_[i]->setChannelFillGraph(stages_[i - 1]);
  }
  QColor band = palette().color(QPalette::Text);
  band.setAlpha(40);
  bandLow_->setPen(Qt::NoPen);
  bandHigh_->setPen(Qt::NoPen);
  bandHigh_->setBrush(band);
  asked_->setPen(QPen(seriesColour(0, palette()), 1.5, Qt::DotLine));
  budget_->setPen(QPen(errorColour(palette()), 1.5, Qt::DashLine));
  measured_->setPen(QPen(palette().color(QPalette::Text), 1.5));
  recorded_->setPen(QPen(seriesColour(int(stages_.size()) + 1, palette()), 1.5, Qt::DashDotLine));
  arrangeLegendAbove();
  replot(QCustomPlot::rpQueuedReplot);
}

}  // namespace trimtab::views
