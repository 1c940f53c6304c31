// SPDX-License-Identifier: GPL-3.0-or-later
#include "motion_plot.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "views/model/theme.h"

namespace trimtab::views {

MotionPlot::MotionPlot(QWidget* parent) : Plot(tr("Head motion over time"), Keyboard::ignored, parent) {
  setPlottingHints(QCP::phFastPolylines | QCP::phCacheLabels);
  setNotAntialiasedElements(QCP::aeAxes | QCP::aeGrid | QCP::aeFills);
  xAxis->setLabel(tr("Time (s)"));
  yAxis->setLabel(tr("Rate (deg/s)"));
  yAxis2->setLabel(tr("LOD scale"));
  yAxis2->setVisible(true);
  for (QCPAxis* axis : {xAxis, yAxis, yAxis2}) {
    axis->setSubTicks(false);
    axis->ticker()->setTickCount(4);
  }
  xAxis->setNumberFormat(QStringLiteral("g"));
  blur_ = addGraph(xAxis, yAxis2);
  blur_->setName(tr("blur"));
  scale_ = addGraph(xAxis, yAxis2);
  scale_->setName(tr("LOD scale, right"));
  for (QCPGraph* steps : {blur_, scale_}) steps->setLineStyle(QCPGraph::lsStepLeft);
  threshold_ = addGraph();
  threshold_->setName(tr("threshold"));
  rate_ = addGraph();
  rate_->setName(tr("rate"));
  legend->setVisible(true);
  legend->setFillOrder(QCPLayoutGrid::foColumnsFirst);
  legend->setMargins(QMargins(4, 1, 4, 1));
  legend->setIconSize(22, 10);
  axisRect()->insetLayout()->setInsetAlignment(0, Qt::AlignLeft | Qt::AlignTop);
  restyle();
}

void MotionPlot::append(const LiveFrame& frame) {
  const double time = frame.time;
  if (time < last_)
    for (QCPGraph* graph : {rate_, threshold_, scale_, blur_}) graph->data()->clear();
  last_ = time;
  const MotionDecision& motion = frame.decision.motion;
  rate_->addData(time, motion.rateDegPerS);
  threshold_->addData(time, motion.thresholdDegPerS);
  scale_->addData(time, motion.lodScale);
  blur_->addData(time, motion.blur.strength > 0 ? 1e6 : 0);
  for (QCPGraph* graph : {rate_, threshold_, scale_, blur_}) graph->data()->removeBefore(time - kSpanS);
}

void MotionPlot::refresh() {
  double threshold = 0, scale = 1;
  std::vector<double> rates;
  for (const QCPGraphData& point : *rate_->data())
    if (std::isfinite(point.value)) rates.push_back(point.value);
  for (const QCPGraphData& point : *threshold_->data()) threshold = std::max(threshold, point.value);
  std::sort(rates.begin(), rates.end());
  // A jump of the view, as of the key Home, is thousands of degrees in no time: it ends above the axis.
  const double usual = rates.empty() ? 0 : rates[rates.size() - 1 - rates.size() / 20];
  const double largest = rates.empty() ? 0 : rates.back();
  const double top = std::max(threshold, std::min(largest, kMostOverUsual * std::max(usual, threshold)));
  for (const QCPGraphData& point : *scale_->data()) scale = std::max(scale, point.value);
  xAxis->setRange(last_ - kSpanS, last_);
  // Room for the legend above what moves.
  yAxis->setRange(0, std::max(top, 1.0) * 1.35);
  yAxis2->setRange(0, std::max(scale, 4.0) * 1.35);
  replot(QCustomPlot::rpQueuedReplot);
}

void MotionPlot::restyle() {
  applyTheme(*this);
  rate_->setPen(QPen(seriesColour(0, palette()), 1.5));
  threshold_->setPen(QPen(errorColour(palette()), 1.5, Qt::DashLine));
  scale_->setPen(QPen(seriesColour(1, palette()), 2));
  QColor shade = seriesColour(4, palette());
  shade.setAlpha(60);
  blur_->setPen(Qt::NoPen);
  blur_->setBrush(shade);
  replot(QCustomPlot::rpQueuedReplot);
}

}  // namespace trimtab::views
