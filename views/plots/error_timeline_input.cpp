// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <limits>

#include "error_timeline.h"

// ErrorTimeline's mouse and keyboard.
namespace trimtab::views {
namespace {

constexpr int kPageFrames = 10;
constexpr double kShortestSpanS = 0.1;

}  // namespace

void ErrorTimeline::stepFrames(int frames) {
  if (times_.empty()) return;
  const double at = std::isfinite(cursor_) ? cursor_ : times_.front();
  // Between two frames the first step goes to the neighbour.
  const auto next = std::upper_bound(times_.begin(), times_.end(), at + 1e-9);
  const auto here = std::lower_bound(times_.begin(), times_.end(), at - 1e-9);
  const std::ptrdiff_t index =
      frames > 0 ? next - times_.begin() + frames - 1 : here - times_.begin() + frames;
  seek(times_[std::size_t(std::clamp<std::ptrdiff_t>(index, 0, std::ssize(times_) - 1))]);
}

void ErrorTimeline::stepWorst(int direction) {
  if (worst_.empty()) return;
  const auto timeOf = [this](const Worst& w) { return run_.series[w.series].timeS[w.frame]; };
  const double at = std::isfinite(cursor_) ? cursor_ : -std::numeric_limits<double>::infinity();
  if (direction > 0) {
    for (const Worst& w : worst_)
      if (timeOf(w) > at + 1e-9) return seek(timeOf(w));
    return seek(timeOf(worst_.front()));
  }
  for (auto w = worst_.rbegin(); w != worst_.rend(); ++w)
    if (timeOf(*w) < at - 1e-9) return seek(timeOf(*w));
  seek(timeOf(worst_.back()));
}

void ErrorTimeline::mousePressEvent(QMouseEvent* event) {
  if (event->button() != Qt::LeftButton) return;
  dragging_ = true;
  seek(time()->pixelToCoord(event->position().x()));
}

void ErrorTimeline::mouseMoveEvent(QMouseEvent* event) {
  const double at = time()->pixelToCoord(event->position().x());
  if (dragging_) seek(at);
  showNumbers(at, event->position());
}

void ErrorTimeline::mouseReleaseEvent(QMouseEvent*) {
  dragging_ = false;
}

void ErrorTimeline::zoom(double factor, double anchor) {
  const QCPRange range = time()->range();
  if (range.size() * factor < kShortestSpanS || whole_.size() == 0) return;
  const QCPRange zoomed =
      QCPRange(anchor - (anchor - range.lower) * factor, anchor + (range.upper - anchor) * factor)
          .bounded(whole_.lower, whole_.upper);
  for (int lane = 0; lane < 2; ++lane) time(lane)->setRange(zoomed);
  placeCursor();
  replot(QCustomPlot::rpQueuedReplot);
}

void ErrorTimeline::zoomByWheel(QWheelEvent* event) {
  zoom(wheelFactor(*event), time()->pixelToCoord(event->position().x()));
}

bool ErrorTimeline::zoomByKey(double factor) {
  zoom(factor, time()->range().contains(cursor_) ? cursor_ : time()->range().center());
  return true;
}

void ErrorTimeline::keyPressEvent(QKeyEvent* event) {
  const int frames = event->modifiers() & Qt::ShiftModifier ? kPageFrames : 1;
  switch (event->key()) {
    case Qt::Key_Left:
      return stepFrames(-frames);
    case Qt::Key_Right:
      return stepFrames(frames);
    case Qt::Key_PageUp:
      return stepFrames(-kPageFrames);
    case Qt::Key_PageDown:
      return stepFrames(kPageFrames);
    case Qt::Key_Home:
      return times_.empty() ? void() : seek(times_.front());
    case Qt::Key_End:
      return times_.empty() ? void() : seek(times_.back());
    case Qt::Key_W:
      return stepWorst(event->modifiers() & Qt::ShiftModifier ? -1 : 1);
    default:
      return Plot::keyPressEvent(event);
  }
}

void ErrorTimeline::leaveEvent(QEvent* event) {
  numbers_->setVisible(false);
  layer(QStringLiteral("numbers"))->replot();
  QCustomPlot::leaveEvent(event);
}

}  // namespace trimtab::views
