// SPDX-License-Identifier: GPL-3.0-or-later
#include <QContextMenuEvent>
#include <QMenu>
#include <cmath>

#include "curve_plot.h"
#include "views/model/theme.h"

/// CurvePlot's mouse and keyboard.
namespace trimtab::views {

namespace {

constexpr double kGrabPx = 10;
constexpr double kMembershipStep = 0.01;

double rounded(double value, double step) {
  return std::round(value / step) * step;
}

}  // namespace

void CurvePlot::select(int index) {
  const int last = static_cast<int>(curve().size) - 1;
  index = std::clamp(index, -1, last);
  if (index == selected_) return;
  selected_ = index;
  redraw();
  emit selectedChanged(index);
}

int CurvePlot::pointAt(QPointF pixel) const {
  int nearest = -1;
  double best = kGrabPx;
  const CurvePoints points = curve();
  for (std::size_t i = 0; i < points.size; ++i) {
    const QPointF d = pixelOf(points.point[i]) - pixel;
    const double distance = std::hypot(d.x(), d.y());
    // At equal distance the selected one wins: it is drawn on top.
    if (distance < best || (distance == best && static_cast<int>(i) == selected_)) {
      best = distance;
      nearest = static_cast<int>(i);
    }
  }
  return nearest;
}

CurvePoint CurvePlot::valueAt(QPointF pixel) const {
  // As round as the screen can show: no drag ends at 4987.3341 ft.
  const double xStep =
      std::max(pointGap(spec_), roundStep(xAxis->range().size() / std::max(1, axisRect()->width())));
  return {rounded(xAxis->pixelToCoord(pixel.x()), xStep),
          std::clamp(rounded(yAxis->pixelToCoord(pixel.y()), kMembershipStep), 0.0, 1.0)};
}

void CurvePlot::commit(const CurvePoints& changed, MergeToken token) {
  const Findings refusedBecause = draft_.setValue(spec_.key, changed, token);
  if (!refusedBecause.empty()) emit refused(QString::fromStdString(toString(refusedBecause)));
}

void CurvePlot::mousePressEvent(QMouseEvent* event) {
  const int hit = pointAt(event->position());
  if (event->button() == Qt::LeftButton && hit >= 0 && editable()) {
    select(hit);
    dragToken_ = draft_.newToken();
    dragStart_ = curve();
    grabOffset_ = pixelOf(dragStart_.point[static_cast<std::size_t>(hit)]) - event->position();
    setCursor(Qt::ClosedHandCursor);
    return;
  }
  if (event->button() == Qt::LeftButton && hit < 0) select(-1);
  Plot::mousePressEvent(event);
}

void CurvePlot::mouseMoveEvent(QMouseEvent* event) {
  if (dragToken_ != 0 && selected_ >= 0) {
    CurvePoint to = valueAt(event->position() + grabOffset_);
    const CurvePoint from = dragStart_.point[static_cast<std::size_t>(selected_)];
    if (event->modifiers() & Qt::ShiftModifier) {
      // Shift keeps to the axis along which the drag has gone farther.
      const QPointF gone = pixelOf(to) - pixelOf(from);
      (std::abs(gone.x()) > std::abs(gone.y()) ? to.y : to.x) =
          std::abs(gone.x()) > std::abs(gone.y()) ? from.y : from.x;
    }
    commit(withMoved(curve(), static_cast<std::size_t>(selected_), to, spec_), dragToken_);
    drawHover(pixelOf(curve().point[static_cast<std::size_t>(selected_)]));
    return;
  }
  setCursor(pointAt(event->position()) >= 0 && editable() ? Qt::OpenHandCursor : Qt::ArrowCursor);
  drawHover(event->position());
  Plot::mouseMoveEvent(event);
}

void CurvePlot::mouseReleaseEvent(QMouseEvent* event) {
  if (dragToken_ != 0 && event->button() == Qt::LeftButton) {
    dragToken_ = 0;
    setCursor(Qt::OpenHandCursor);
    return;
  }
  Plot::mouseReleaseEvent(event);
}

void CurvePlot::mouseDoubleClickEvent(QMouseEvent* event) {
  if (event->button() != Qt::LeftButton) return;
  if (pointAt(event->position()) < 0 && axisRect()->rect().contains(event->position().toPoint()))
    addPoint(valueAt(event->position()));
}

void CurvePlot::cancelDrag() {
  const MergeToken token = std::exchange(dragToken_, 0);
  commit(dragStart_, token);
  setCursor(Qt::ArrowCursor);
}

void CurvePlot::addPoint(CurvePoint point) {
  if (!editable()) return emit refused(tr("This reading does not use the points."));
  const std::optional<Inserted> inserted = withInserted(curve(), point, spec_);
  if (!inserted)
    return emit refused(
        tr("There is no room for another point here (at most %1 points).").arg(CurvePoints::kCapacity));
  commit(inserted->curve, 0);
  select(static_cast<int>(inserted->index));
}

void CurvePlot::addPointBesideSelected() {
  const CurvePoints points = curve();
  if (points.size < 2) return;
  const std::size_t left = std::min(static_cast<std::size_t>(std::max(selected_, 0)), points.size - 2);
  const CurvePoint a = points.point[left], b = points.point[left + 1];
  addPoint({rounded((a.x + b.x) / 2, pointGap(spec_)), (a.y + b.y) / 2});
}

void CurvePlot::removeSelected() {
  if (selected_ < 0 || !editable()) return;
  const std::optional<CurvePoints> removed = withRemoved(curve(), static_cast<std::size_t>(selected_));
  if (!removed) return emit refused(tr("A curve keeps at least two points."));
  commit(*removed, 0);
}

void CurvePlot::nudge(double dx, double dy) {
  if (selected_ < 0 || !editable()) return;
  if (nudgeToken_ == 0) nudgeToken_ = draft_.newToken();
  const CurvePoints points = curve();
  const CurvePoint from = points.point[static_cast<std::size_t>(selected_)];
  commit(withMoved(points, static_cast<std::size_t>(selected_), {from.x + dx, rounded(from.y + dy, 1e-6)},
                   spec_),
         nudgeToken_);
}

void CurvePlot::keyPressEvent(QKeyEvent* event) {
  const double times = event->modifiers() & Qt::ShiftModifier ? 10 : 1;
  const double xStep = std::max(findRow(spec_.key)->step, pointGap(spec_)) * times;
  switch (event->key()) {
    case Qt::Key_Escape:
      if (dragToken_ == 0) return event->ignore();
      return cancelDrag();
    case Qt::Key_Left:
      return nudge(-xStep, 0);
    case Qt::Key_Right:
      return nudge(xStep, 0);
    case Qt::Key_Up:
      return nudge(0, kMembershipStep * times);
    case Qt::Key_Down:
      return nudge(0, -kMembershipStep * times);
    case Qt::Key_Insert:
      return addPointBesideSelected();
    case Qt::Key_Delete:
    case Qt::Key_Backspace:
      return removeSelected();
    case Qt::Key_Return:
    case Qt::Key_Enter:
      if (selected_ >= 0) emit typingAsked();
      return;
    case Qt::Key_Home:
      return select(0);
    case Qt::Key_End:
      return select(static_cast<int>(curve().size) - 1);
    default:
      return Plot::keyPressEvent(event);
  }
}

void CurvePlot::keyReleaseEvent(QKeyEvent* event) {
  // A key held down is one undo step.
  if (!event->isAutoRepeat()) nudgeToken_ = 0;
  Plot::keyReleaseEvent(event);
}

bool CurvePlot::focusNextPrevChild(bool next) {
  const int to = selected_ + (next ? 1 : -1);
  if (!editable() || to < 0 || to >= static_cast<int>(curve().size)) return Plot::focusNextPrevChild(next);
  select(to);
  return true;
}

void CurvePlot::focusInEvent(QFocusEvent* event) {
  if (event->reason() == Qt::TabFocusReason) select(0);
  if (event->reason() == Qt::BacktabFocusReason) select(static_cast<int>(curve().size) - 1);
  Plot::focusInEvent(event);
}

void CurvePlot::focusOutEvent(QFocusEvent* event) {
  nudgeToken_ = 0;
  Plot::focusOutEvent(event);
}

void CurvePlot::leaveEvent(QEvent* event) {
  drawHover(std::nullopt);
  Plot::leaveEvent(event);
}

void CurvePlot::contextMenuEvent(QContextMenuEvent* event) {
  const bool byMouse = event->reason() == QContextMenuEvent::Mouse;
  if (byMouse && pointAt(event->pos()) >= 0) select(pointAt(event->pos()));
  QMenu menu(this);
  const CurvePoint here = valueAt(event->pos());
  QAction* add =
      menu.addAction(tr("Add point"), this, [&] { byMouse ? addPoint(here) : addPointBesideSelected(); });
  add->setEnabled(editable() && curve().size < CurvePoints::kCapacity);
  QAction* remove = menu.addAction(tr("Remove point"), this, &CurvePlot::removeSelected);
  remove->setEnabled(editable() && selected_ >= 0 && curve().size > 2);
  menu.addSeparator();
  QAction* reset = menu.addAction(tr("Reset this curve"), this, [this] { draft_.reset(spec_.key); });
  reset->setEnabled(draft_.isChanged(spec_.key));
  menu.addAction(tr("Show all points"), this, &CurvePlot::fitView);
  menu.exec(event->globalPos());
}

}  // namespace trimtab::views
