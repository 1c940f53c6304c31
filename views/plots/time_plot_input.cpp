// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <limits>

#include "time_plot.h"

/// TimePlot's mouse and keyboard.
namespace trimtab::views {

namespace {
constexpr double kGrabPx = 7;
}

int TimePlot::cursorAt(QPointF pixel) const {
  if (!cursors_) return -1;
  int nearest = -1;
  double best = kGrabPx;
  for (int i = 0; i < 2; ++i)
    if (const double d = std::abs(pixelOfTime(cursor(i)).x() - pixel.x()); d < best) {
      best = d;
      nearest = i;
    }
  return nearest;
}

void TimePlot::zoom(double factor, double anchor) {
  const QCPRange range = shown();
  if (following_) return setSpan(range.size() * factor);
  setShown(anchor - (anchor - range.lower) * factor, anchor + (range.upper - anchor) * factor);
}

void TimePlot::mousePressEvent(QMouseEvent* event) {
  if (event->button() != Qt::LeftButton) return;
  draggedCursor_ = cursorAt(event->position());
  if (draggedCursor_ >= 0)
    keyCursor_ = draggedCursor_;
  else
    panFrom_ = timeAxis()->pixelToCoord(event->position().x());
}

void TimePlot::mouseMoveEvent(QMouseEvent* event) {
  const double time = timeAxis()->pixelToCoord(event->position().x());
  if (draggedCursor_ >= 0) {
    moveCursor(draggedCursor_, time);
  } else if (panFrom_) {
    const double by = *panFrom_ - time;
    if (following_) {
      // A click that trembles is no pan.
      if (std::abs(timeAxis()->coordToPixel(*panFrom_) - event->position().x()) < 4) return;
      following_ = false;
      emit movedByHand();
    }
    setShown(shown().lower + by, shown().upper + by);
  } else {
    setCursor(cursorAt(event->position()) >= 0 ? Qt::SplitHCursor : Qt::ArrowCursor);
  }
  for (Lane& lane : lanes_) {
    lane.tracker->setVisible(true);
    putVertical(*lane.tracker, time);
  }
  layer(QStringLiteral("tracker"))->replot();
  emit tracked(time);
}

void TimePlot::mouseReleaseEvent(QMouseEvent*) {
  draggedCursor_ = -1;
  panFrom_.reset();
}

void TimePlot::zoomByWheel(QWheelEvent* event) {
  zoom(wheelFactor(*event), timeAxis()->pixelToCoord(event->position().x()));
}

bool TimePlot::zoomByKey(double factor) {
  zoom(factor, shown().center());
  return true;
}

void TimePlot::keyPressEvent(QKeyEvent* event) {
  const double secondsPerPixel = shown().size() / std::max(1, lanes_.front().rect->width());
  const double step = secondsPerPixel * (event->modifiers() & Qt::ShiftModifier ? 20 : 2);
  const auto move = [&](double by) {
    if (hasCursors()) return moveCursor(keyCursor_, cursor(keyCursor_) + by);
    if (following_) {
      following_ = false;
      emit movedByHand();
    }
    setShown(shown().lower + 10 * by, shown().upper + 10 * by);
  };
  switch (event->key()) {
    case Qt::Key_Left:
      return move(-step);
    case Qt::Key_Right:
      return move(step);
    case Qt::Key_A:
      keyCursor_ = 0;
      return;
    case Qt::Key_B:
      keyCursor_ = 1;
      return;
    case Qt::Key_Space:
      return emit pauseAsked();
    case Qt::Key_F:
    case Qt::Key_End:
      return emit followAsked();
    default:
      return Plot::keyPressEvent(event);
  }
}

void TimePlot::leaveEvent(QEvent* event) {
  for (Lane& lane : lanes_) lane.tracker->setVisible(false);
  layer(QStringLiteral("tracker"))->replot();
  emit tracked(std::numeric_limits<double>::quiet_NaN());
  QCustomPlot::leaveEvent(event);
}

}  // namespace trimtab::views
