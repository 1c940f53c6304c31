// SPDX-License-Identifier: GPL-3.0-or-later
#include "point_plot.h"

#include <algorithm>
#include <cmath>

#include "trimtab/units/not_finite.h"
#include "views/model/theme.h"

namespace trimtab::views {

PointPlot::PointPlot(const QString& accessibleName, Draft& draft, std::string_view key, QWidget* parent)
    : Plot(accessibleName, Keyboard::used, parent), draft_(draft), key_(key) {
  // The live value and the readout move on layers of their own, without a replot of the rest.
  addOverlays({"live", "hover"});
  ghosts_.emplace(*this, draft_);
  axisRect()->setRangeZoom(Qt::Horizontal);
  axisRect()->setRangeZoomFactor(kWheelZoom);
  setInteraction(QCP::iRangeZoom);
  axisRect()->setupFullAxesBox();
  points_ = addGraph();
  chosen_ = addGraph();
  for (QCPGraph* graph : {points_, chosen_}) {
    graph->setLineStyle(QCPGraph::lsNone);
    graph->setAdaptiveSampling(false);
    // Points lie over the curves that a plot adds later.
    graph->setLayer(QStringLiteral("axes"));
  }
  liveText_ = addReadout("live", QMargins(4, 1, 4, 1));
  readout_ = addReadout("hover", QMargins(5, 3, 5, 3));
  connect(this, &QCustomPlot::mouseWheel, this, [this] { fitted_ = false; });
  connect(xAxis, qOverload<const QCPRange&>(&QCPAxis::rangeChanged), this, [this] {
    if (!fitted_) redraw();
  });
  connect(&draft_, &Draft::loaded, this, &PointPlot::fitView);
  connect(&draft_, &Draft::findingsChanged, this, [this] {
    if (isAtFault() != shownAtFault_) redraw();
  });
}

void PointPlot::restyle() {
  const QColor base = palette().color(QPalette::Base), live = liveColour(palette());
  ghosts_->restyle(palette());
  liveText_->setColor(live);
  liveText_->setPen(QPen(live));
  liveText_->setBrush(base);
  liveText_->setFont(font());
  redraw();
}

void PointPlot::fitView() {
  fitted_ = true;
  const Range view = wholeView();
  xAxis->setRange(view.low, view.high);
  redraw();
}

void PointPlot::fitViewUnlessMoving() {
  fitted_ && !moving() ? fitView() : redraw();
}

bool PointPlot::zoomByKey(double factor) {
  fitted_ = false;
  xAxis->scaleRange(factor);
  redraw();
  return true;
}

bool PointPlot::isAtFault() const {
  return draft_.isBroken() && !draft_.findingsOf(key_).empty();
}

QVector<double> PointPlot::samples(const QVector<double>& jumps) const {
  const QCPRange range = xAxis->range();
  const int steps = std::max(200, axisRect()->width());
  QVector<double> at;
  for (int i = 0; i <= steps; ++i) at << range.lower + range.size() * i / steps;
  for (const double x : jumps)
    if (range.contains(x)) at << std::nextafter(x, -kInfinity) << x << std::nextafter(x, kInfinity);
  std::ranges::sort(at);
  return at;
}

void PointPlot::showPoints(const QColor& colour) {
  shownAtFault_ = isAtFault();
  const QColor base = palette().color(QPalette::Base), edge = shownAtFault_ ? errorColour(palette()) : colour;
  points_->setScatterStyle(
      {QCPScatterStyle::ssSquare, QPen(editable() ? edge : blend(base, edge, 0.4), 1.6), QBrush(base), 9});
  chosen_->setScatterStyle({QCPScatterStyle::ssSquare, QPen(edge, 1.6), QBrush(edge), 12});
  const std::vector<EditPoint> points = this->points();
  QVector<double> x, y;
  for (const EditPoint& point : points) x << point.x, y << point.y;
  points_->setData(x, y);
  if (selected() >= static_cast<int>(points.size())) selection_.choose(-1);
  chosen_->data()->clear();
  if (editable())
    for (const std::size_t i : group()) chosen_->addData(points[i].x, points[i].y);
  const int label = fontMetrics().horizontalAdvance(QStringLiteral("-000000 "));
  xAxis->ticker()->setTickCount(std::clamp(axisRect()->width() / label, 2, 8));
  setAccessibleDescription(describe());
  replot(rpQueuedReplot);
}

void PointPlot::putLiveText(double x, QString text, QPointF pixel, bool above) {
  const QCPRange range = xAxis->range();
  if (x > range.upper) text += QStringLiteral(" →");
  if (x < range.lower) text.prepend(QStringLiteral("← "));
  const bool left = pixel.x() > axisRect()->center().x();
  liveText_->setText(text);
  liveText_->setPositionAlignment((left ? Qt::AlignRight : Qt::AlignLeft) |
                                  (above ? Qt::AlignBottom : Qt::AlignTop));
  liveText_->position->setCoords(pixel + QPointF(left ? -9 : 9, above ? -9 : 9));
}

void PointPlot::say(const std::optional<QPointF>& at) {
  const bool shown = at && axisRect()->rect().contains(at->toPoint());
  if (!shown && !readout_->visible()) return;
  readout_->setVisible(shown);
  if (shown) {
    const int point = drag_ != 0 ? selected() : pointAt(*at);
    const double x = point >= 0 ? points()[static_cast<std::size_t>(point)].x : xAxis->pixelToCoord(at->x());
    placeReadout(*readout_, readoutOf(x, point), *at);
  }
  layer(QStringLiteral("hover"))->replot();
}

}  // namespace trimtab::views
