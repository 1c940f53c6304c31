// SPDX-License-Identifier: GPL-3.0-or-later
#include "motion_plot.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "views/model/theme.h"

namespace trimtab::views {
namespace {

constexpr double kMotionHeadRoom = 1.1;

}  // namespace

MotionPlot::MotionPlot(QWidget* parent) : ClockPlot(tr("Head motion over time"), Keyboard::ignored, parent) {
  setPlottingHints(QCP::phFastPolylines | QCP::phCacheLabels);
  setNotAntialiasedElements(QCP::aeAxes | QCP::aeGrid | QCP::aeFills);
  addLegendAbove();
  xAxis->setLabel(tr("Time (s)"));
  yAxis->setLabel(tr("Rate (deg/s)"));
  yAxis2->setLabel(tr("LOD scale by head motion"));
  yAxis2->setVisible(true);
  for (QCPAxis* axis : {xAxis, yAxis, yAxis2}) {
    axis->setSubTicks(false);
    axis->ticker()->setTickCount(4);
  }
  xAxis->setNumberFormat(QStringLiteral("g"));
  blur_ = addGraph(xAxis, yAxis2);
  blur_->setName(tr("blur asked for"));
  scale_ = addGraph(xAxis, yAxis2);
  scale_->setName(tr("LOD scale, right"));
  for (QCPGraph* steps : {blur_, scale_}) steps->setLineStyle(QCPGraph::lsStepLeft);
  threshold_ = addGraph();
  threshold_->setName(tr("threshold"));
  rate_ = addGraph();
  rate_->setName(tr("rate"));
  for (QCPGraph* graph : {rate_, threshold_, scale_, blur_}) graph->addToLegend();
  addOverlays({"tracker"});
  trackIn({axisRect()});
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
  // A jump of the view, as the key Home makes one, is thousands of degrees in no time and leaves the axis.
  const double usual = rates.empty() ? 0 : rates[rates.size() - 1 - rates.size() / 20];
  const double largest = rates.empty() ? 0 : rates.back();
  const double top = std::max(threshold, std::min(largest, kMostOverUsual * std::max(usual, threshold)));
  for (const QCPGraphData& point : *scale_->data()) scale = std::max(scale, point.value);
  xAxis->setRange(last_ - kSpanS, last_);
  yAxis->setRange(0, std::max(top, 1.0) * kMotionHeadRoom);
  yAxis2->setRange(0, std::max(scale, 4.0) * kMotionHeadRoom);
  replot(QCustomPlot::rpQueuedReplot);
}

void MotionPlot::restyle() {
  applyThemeWithLegendAbove();
  styleTracker();
  rate_->setPen(QPen(seriesColour(0, palette()), 1.5));
  threshold_->setPen(QPen(errorColour(palette()), 1.5, Qt::DashLine));
  scale_->setPen(QPen(seriesColour(1, palette()), 2));
  QColor shade = seriesColour(4, palette());
  shade.setAlpha(60);
  blur_->setPen(Qt::NoPen);
  blur_->setBrush(shade);
  arrangeLegendAbove();
  replot(QCustomPlot::rpQueuedReplot);
}

}  // namespace trimtab::views
