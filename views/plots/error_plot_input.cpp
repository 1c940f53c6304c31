// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "error_plot.h"

// ErrorPlot's mouse and keyboard.
namespace trimtab::views {
namespace {

constexpr double kPointGrabPx = 12;

}  // namespace

int ErrorPlot::pointAt(QPointF pixel) const {
  int nearest = -1;
  double best = kPointGrabPx;
  const auto look = [&](QPointF at, int which) {
    const double d = std::hypot(at.x() - pixel.x(), at.y() - pixel.y());
    if (d < best) {
      best = d;
      nearest = which;
    }
  };
  for (std::size_t i = 0; i < points_.size(); ++i) look(pixelOf(points_[i]), int(i));
  if (!tail_.empty()) look(livePixel(), int(points_.size()));
  return nearest;
}

void ErrorPlot::mouseMoveEvent(QMouseEvent* event) {
  if (event->buttons() & Qt::LeftButton)
    fitted_ = false;
  else
    select(pointAt(event->position()));
  Plot::mouseMoveEvent(event);
}

void ErrorPlot::mouseDoubleClickEvent(QMouseEvent* event) {
  fitView();
  event->accept();
}

void ErrorPlot::leaveEvent(QEvent* event) {
  select(-1);
  Plot::leaveEvent(event);
}

bool ErrorPlot::zoomByKey(double factor) {
  fitted_ = false;
  xAxis->scaleRange(factor);
  yAxis->scaleRange(factor);
  redraw();
  return true;
}

void ErrorPlot::keyPressEvent(QKeyEvent* event) {
  const int count = int(points_.size()) + (tail_.empty() ? 0 : 1);
  switch (event->key()) {
    case Qt::Key_Right:
      return select(count == 0 ? -1 : (selected_ + 1) % count);
    case Qt::Key_Left:
      return select(count == 0 ? -1 : (selected_ + count - (selected_ < 0 ? 0 : 1)) % count);
    case Qt::Key_Escape:
      return select(-1);
    case Qt::Key_L:
      return setLogarithmic(!logarithmic());
    case Qt::Key_F:
      return fitView();
    default:
      return Plot::keyPressEvent(event);
  }
}

}  // namespace trimtab::views
