// SPDX-License-Identifier: GPL-3.0-or-later
#include "budget_plot.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "trimtab/hold/cost_model.h"
#include "views/model/theme.h"

namespace trimtab::views {

namespace {

constexpr double kGap = std::numeric_limits<double>::quiet_NaN();
/// From this width on the parts are beside each other.
constexpr int kBesidePx = 560, kPartPx = 96;

/// Returns what all but one value in fifty keep to: a spike does not flatten the plot.
double mostOf(std::vector<double>& values) {
  const auto most = values.begin() + std::ptrdiff_t(double(values.size() - 1) * 0.98);
  std::nth_element(values.begin(), most, values.end());
  return *most;
}

}  // namespace

BudgetPlot::BudgetPlot(QWidget* parent)
    : ClockPlot(tr("Predicted and measured frame time"), Keyboard::ignored, parent) {
  setPlottingHints(QCP::phFastPolylines | QCP::phCacheLabels);
  setNotAntialiasedElements(QCP::aeAxes | QCP::aeGrid | QCP::aeFills);
  addLegendAbove();
  makeParts();
  predicted_ = makeStack(predictedPart);
  measured_ = makeStack(measuredPart);
  bandLow_ = makeLine(predictedPart);
  bandHigh_ = makeLine(predictedPart, tr("90 % band"));
  asked_ = makeLine(predictedPart, tr("not held"));
  budget_ = makeLine(predictedPart, tr("budget"));
  total_ = makeLine(predictedPart, tr("measured"));
  measuredBudget_ = makeLine(measuredPart);
  recorded_ = makeLine(measuredPart, tr("recorded"));
  offLow_ = makeLine(offPart);
  offHigh_ = makeLine(offPart);
  none_ = makeLine(offPart);
  off_ = makeLine(offPart);
  bandHigh_->setChannelFillGraph(bandLow_);
  offHigh_->setChannelFillGraph(offLow_);
  for (QCPGraph* graph : {total_, recorded_, budget_, asked_, bandHigh_}) graph->addToLegend(legend);
  for (QCPGraph* graph : predicted_) graph->addToLegend(legend);
  addOverlays({"tracker"});
  trackIn({parts_.begin(), parts_.end()});
  arrangeParts();
  restyle();
}

void BudgetPlot::makeParts() {
  grid_ = new QCPLayoutGrid;
  parts_[predictedPart] = axisRect();
  plotLayout()->take(axisRect());
  plotLayout()->addElement(1, 0, grid_);
  grid_->setRowSpacing(0);
  auto* margins = new QCPMarginGroup(this);
  const std::array<QString, kParts> labels{tr("Predicted (ms)"), tr("Measured (ms)"), tr("Off by (%)")};
  for (std::size_t i = 0; i < kParts; ++i) {
    if (parts_[i] == nullptr) parts_[i] = new QCPAxisRect(this, true);
    QCPAxisRect& part = *parts_[i];
    grid_->addElement(static_cast<int>(i), 0, &part);
    part.setMarginGroup(QCP::msAll, margins);
    part.axis(QCPAxis::atLeft)->setLabel(labels[i]);
    part.axis(QCPAxis::atBottom)->setLabel(tr("Time (s)"));
    part.axis(QCPAxis::atBottom)->setNumberFormat(QStringLiteral("g"));
    for (const auto type : {QCPAxis::atLeft, QCPAxis::atBottom}) {
      QCPAxis* axis = part.axis(type);
      axis->setSubTicks(false);
      axis->ticker()->setTickCount(3);
      for (QCPLayerable* each : {static_cast<QCPLayerable*>(axis), static_cast<QCPLayerable*>(axis->grid())})
        each->setLayer(each == axis ? QStringLiteral("axes") : QStringLiteral("grid"));
    }
  }
}

QCPGraph* BudgetPlot::makeLine(Part part, const QString& name) {
  QCPGraph* graph = addGraph(parts_[part]->axis(QCPAxis::atBottom), parts_[part]->axis(QCPAxis::atLeft));
  graph->setName(name);
  return graph;
}

BudgetPlot::Stack BudgetPlot::makeStack(Part part) {
  const std::array<QString, 4> names{tr("ground"), tr("weather"), tr("blur"), tr("other")};
  Stack stack{};
  for (std::size_t i = 0; i < stack.size(); ++i) stack[i] = makeLine(part, names[i]);
  return stack;
}

void BudgetPlot::arrangeParts() {
  for (QCPAxisRect* part : parts_) grid_->take(part);
  grid_->simplify();
  for (int i = 0; i < int(kParts); ++i)
    grid_->addElement(wide_ ? 0 : i, wide_ ? i : 0, parts_[std::size_t(i)]);
  const QList<double> shares{3, 3, 2}, one{1};
  grid_->setRowStretchFactors(wide_ ? one : shares);
  grid_->setColumnStretchFactors(wide_ ? shares : one);
  for (std::size_t i = 0; i < kParts; ++i) {
    const bool lowest = wide_ || i + 1 == kParts;
    parts_[i]->axis(QCPAxis::atBottom)->setLabel(lowest ? tr("Time (s)") : QString());
    parts_[i]->axis(QCPAxis::atBottom)->setTickLabels(lowest);
  }
  updateGeometry();
}

QSize BudgetPlot::minimumSizeHint() const {
  const int legendPx = (wide_ ? 2 : 4) * (fontMetrics().height() + 2);
  return {240, (wide_ ? 1 : int(kParts)) * kPartPx + legendPx};
}

void BudgetPlot::resized() {
  if (const bool wide = width() >= kBesidePx; std::exchange(wide_, wide) != wide) arrangeParts();
  arrangeLegendAbove();
}

void BudgetPlot::addStack(const Stack& stack, double time, const StageTimes& times, bool known) {
  double sum = 0;
  const std::array<double, 4> stages{times.ground, times.weather, times.blur, times.other};
  for (std::size_t i = 0; i < stack.size(); ++i) {
    sum += stages[i];
    stack[i]->addData(time, known ? sum : kGap);
  }
}

void BudgetPlot::append(const LiveFrame& frame, double budgetMs) {
  const HoldDecision& hold = frame.hold;
  const double time = frame.time;
  if (time < last_ || graph(0)->data()->isEmpty()) begin_ = time;
  if (time < last_)
    for (int i = 0; i < graphCount(); ++i) graph(i)->data()->clear();
  last_ = time;
  // A value that is not a number is a gap.
  const bool predicted = hold.reason != HoldReason::off && hold.heldMs.total() > 0;
  const auto orGap = [predicted](double ms) { return predicted ? ms : kGap; };
  addStack(predicted_, time, hold.heldMs, predicted);
  addStack(measured_, time, stagesOf(frame.cost), std::isfinite(workMs(frame.cost)));
  const double heldMs = hold.heldMs.total();
  bandLow_->addData(time, orGap(std::max(heldMs - hold.halfBandMs, 0.0)));
  bandHigh_->addData(time, orGap(heldMs + hold.halfBandMs));
  asked_->addData(time, orGap(hold.askedMs.total()));
  budget_->addData(time, budgetMs);
  measuredBudget_->addData(time, budgetMs);
  total_->addData(time, workMs(frame.cost));
  const auto& outcome = frame.holdOutcome;
  const bool due = hold.reason != HoldReason::off && outcome && outcome->ms > 0;
  off_->addData(time, due ? 100 * (outcome->predictedMs / outcome->ms - 1) : kGap);
  offLow_->addData(time, due ? -100 * outcome->halfBandMs / outcome->ms : kGap);
  offHigh_->addData(time, due ? 100 * outcome->halfBandMs / outcome->ms : kGap);
  none_->addData(time, 0);
  for (int i = 0; i < graphCount(); ++i) graph(i)->data()->removeBefore(time - kSpanS);
}

void BudgetPlot::overlay(const RecordedRun& run, double atS) {
  recorded_->data()->clear();
  for (std::size_t i = 0; i < run.images(); ++i)
    recorded_->addData(atS + run.states()[i].time - run.states()[0].time, run.ms()[i]);
}

void BudgetPlot::refresh() {
  double top = 1;
  std::vector<double> values;
  const auto take = [&values](const QCPGraph& from) {
    for (const QCPGraphData& point : *from.data())
      if (std::isfinite(point.value)) values.push_back(std::abs(point.value));
  };
  for (const QCPGraph* graph : {asked_, total_, recorded_, budget_}) {
    values.clear();
    take(*graph);
    if (!values.empty()) top = std::max(top, mostOf(values));
  }
  values.clear();
  take(*off_);
  take(*offHigh_);
  const double off = std::max(5.0, values.empty() ? 0.0 : mostOf(values) * 1.15);
  const double from = std::max(begin_, last_ - kSpanS);
  for (QCPAxisRect* part : parts_) {
    part->axis(QCPAxis::atBottom)->setRange(from, from + kSpanS);
    part->axis(QCPAxis::atLeft)->setRange(0, top * 1.15);
  }
  parts_[offPart]->axis(QCPAxis::atLeft)->setRange(-off, off);
  replot(QCustomPlot::rpQueuedReplot);
}

void BudgetPlot::restyle() {
  applyThemeWithLegendAbove();
  styleTracker();
  for (const Stack* stack : {&predicted_, &measured_})
    for (std::size_t i = 0; i < stack->size(); ++i) {
      QColor fill = seriesColour(int(i) + 1, palette());
      (*stack)[i]->setPen(QPen(fill, 1));
      fill.setAlpha(70);
      (*stack)[i]->setBrush(fill);
      if (i > 0) (*stack)[i]->setChannelFillGraph((*stack)[i - 1]);
    }
  const QColor ink = palette().color(QPalette::Text);
  QColor band = ink;
  band.setAlpha(40);
  for (QCPGraph* graph : {bandLow_, bandHigh_, offLow_, offHigh_}) graph->setPen(Qt::NoPen);
  for (QCPGraph* graph : {bandHigh_, offHigh_}) graph->setBrush(band);
  asked_->setPen(QPen(seriesColour(0, palette()), 1.5, Qt::DotLine));
  for (QCPGraph* graph : {budget_, measuredBudget_})
    graph->setPen(QPen(errorColour(palette()), 1.5, Qt::DashLine));
  for (QCPGraph* graph : {total_, off_}) graph->setPen(QPen(ink, 1.5));
  QColor quiet = ink;
  quiet.setAlpha(110);
  none_->setPen(QPen(quiet, 1));
  recorded_->setPen(QPen(seriesColour(5, palette()), 1.5, Qt::DashDotLine));
  arrangeLegendAbove();
  replot(QCustomPlot::rpQueuedReplot);
}

}  // namespace trimtab::views
