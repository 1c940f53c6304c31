// SPDX-License-Identifier: GPL-3.0-or-later
#include "clock_plot.h"

#include "trimtab/units/not_finite.h"
#include "views/model/theme.h"

namespace trimtab::views {

void ClockPlot::showTracker(double time) {
  tracker_.place(time);
  layer(QStringLiteral("tracker"))->replot();
}

void ClockPlot::trackIn(const std::vector<QCPAxisRect*>& rects) {
  rects_ = rects;
  tracker_.attach(*this, "tracker", rects);
}

void ClockPlot::styleTracker() {
  const QColor base = palette().color(QPalette::Base), ink = palette().color(QPalette::Text);
  tracker_.setLook(QPen(blend(base, ink, 0.4), 1, Qt::DotLine), std::nullopt, font());
}

std::optional<double> ClockPlot::timeAt(QPointF pixel) const {
  for (const QCPAxisRect* rect : rects_)
    if (rect->rect().contains(pixel.toPoint())) return rect->axis(QCPAxis::atBottom)->pixelToCoord(pixel.x());
  return std::nullopt;
}

void ClockPlot::mouseMoveEvent(QMouseEvent* event) {
  const double time = timeAt(event->position()).value_or(kNan);
  showTracker(time);
  emit tracked(time);
}

void ClockPlot::mouseReleaseEvent(QMouseEvent* event) {
  if (event->button() != Qt::LeftButton) return Plot::mouseReleaseEvent(event);
  if (const auto time = timeAt(event->position())) emit timeClicked(*time);
}

void ClockPlot::leaveEvent(QEvent* event) {
  showTracker(kNan);
  emit tracked(kNan);
  Plot::leaveEvent(event);
}

}  // namespace trimtab::views
