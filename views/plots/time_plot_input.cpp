// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "time_plot.h"

/// TimePlot's mouse and keyboard.
namespace trimtab::views {

namespace {
constexpr double kTimeGrabPx = 7, kPanPx = 4;
}

/// Asks the lane under the pointer, because lanes may be in two columns.
double TimePlot::timeAtPixel(QPointF pixel) const {
  return lanes_[laneAt(pixel)].rect->axis(QCPAxis::atBottom)->pixelToCoord(pixel.x());
}

double TimePlot::secondsPerPixel() const {
  return shown().size() / std::max(1, lanes_.front().rect->width());
}

int TimePlot::cursorAt(QPointF pixel) const {
  if (!cursors_) return -1;
  int nearest = -1;
  double best = kTimeGrabPx * secondsPerPixel();
  const double time = timeAtPixel(pixel);
  for (int i = 0; i < 2; ++i)
    if (const double d = std::abs(cursor(i) - time); d < best) {
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
  current_ = laneAt(event->position());
  draggedCursor_ = cursorAt(event->position());
  panned_ = false;
  if (draggedCursor_ >= 0)
    keyCursor_ = draggedCursor_;
  else
    panFrom_ = timeAtPixel(event->position());
}

void TimePlot::mouseMoveEvent(QMouseEvent* event) {
  const double time = timeAtPixel(event->position());
  if (draggedCursor_ >= 0) {
    moveCursor(draggedCursor_, time);
  } else if (panFrom_) {
    const double by = *panFrom_ - time;
    // A click that trembles is no pan.
    if (!panned_ && std::abs(by) < kPanPx * secondsPerPixel()) return;
    panned_ = true;
    if (following_) {
      following_ = false;
      emit movedByHand();
    }
    setShown(shown().lower + by, shown().upper + by);
  } else {
    setCursor(cursorAt(event->position()) >= 0 ? Qt::SplitHCursor : Qt::ArrowCursor);
  }
  showTracker(time);
  emit tracked(time);
}

void TimePlot::mouseReleaseEvent(QMouseEvent* event) {
  const bool click = panFrom_ && !panned_ && event->button() == Qt::LeftButton;
  draggedCursor_ = -1;
  panFrom_.reset();
  if (!click) return;
  if (const auto frame = frameAt(timeAtPixel(event->position()))) emit frameClicked(*frame);
}

void TimePlot::zoomByWheel(QWheelEvent* event) {
  zoom(wheelFactor(*event), timeAtPixel(event->position()));
}

bool TimePlot::zoomByKey(double factor) {
  zoom(factor, shown().center());
  return true;
}

void TimePlot::keyPressEvent(QKeyEvent* event) {
  const double step = secondsPerPixel() * (event->modifiers() & Qt::ShiftModifier ? 20 : 2);
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
    case Qt::Key_W:
      return emit spikeAsked(event->modifiers() & Qt::ShiftModifier ? -1 : 1);
    case Qt::Key_Space:
      return emit pauseAsked();
    case Qt::Key_F:
    case Qt::Key_End:
      return emit followAsked();
    default:
      return Plot::keyPressEvent(event);
  }
}

}  // namespace trimtab::views
