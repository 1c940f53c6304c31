// SPDX-License-Identifier: GPL-3.0-or-later
#include <QContextMenuEvent>
#include <QMenu>
#include <cmath>
#include <limits>
#include <utility>

#include "point_plot.h"
#include "views/model/rounded.h"
#include "views/model/theme.h"

/// PointPlot's mouse and keyboard.
namespace trimtab::views {
namespace {

constexpr double kGrabPx = 10;
constexpr int kClickPx = 2;
constexpr double kMembershipStep = 0.01;

}  // namespace

void PointPlot::showSelection() {
  redraw();
  emit selectedChanged(selected());
}

void PointPlot::select(int index) {
  if (selection_.choose(std::clamp(index, -1, static_cast<int>(points().size()) - 1))) showSelection();
}

void PointPlot::forgetSelection() {
  selection_.choose(-1);
  drag_ = nudge_ = 0;
}

void PointPlot::toggle(int index) {
  selection_.toggle(index);
  showSelection();
}

void PointPlot::selectAll() {
  std::vector<int> all(points().size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
  selection_.addBeside(all);
  showSelection();
}

void PointPlot::selectWithin(const QRect& area, bool add) {
  std::vector<int> within;
  const std::vector<EditPoint> points = this->points();
  for (std::size_t i = 0; i < points.size(); ++i)
    if (area.contains(pixelOf(points[i].x, points[i].y).toPoint())) within.push_back(static_cast<int>(i));
  if (!add) selection_.choose(-1);
  selection_.addBeside(within);
  showSelection();
}

void PointPlot::selectElsewhere(QPointF, bool control) {
  if (!control) select(-1);
}

double PointPlot::distance(const EditPoint& point, QPointF pixel) const {
  const QPointF away = pixelOf(point.x, point.y) - pixel;
  return std::hypot(away.x(), away.y());
}

int PointPlot::pointAt(QPointF pixel) const {
  int nearest = -1;
  double best = kGrabPx;
  const std::vector<EditPoint> points = this->points();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double away = distance(points[i], pixel);
    // At equal distance the selected one wins, because it is drawn on top.
    if (away < best || (away == best && static_cast<int>(i) == selected())) {
      best = away;
      nearest = static_cast<int>(i);
    }
  }
  return nearest;
}

QPointF PointPlot::valueAt(QPointF pixel) const {
  const double xStep =
      std::max(finest(), roundStep(xAxis->range().size() / std::max(1, axisRect()->width())));
  return {roundedTo(xAxis->pixelToCoord(pixel.x()), xStep),
          std::clamp(roundedTo(yAxis->pixelToCoord(pixel.y()), kMembershipStep), 0.0, 1.0)};
}

void PointPlot::commit(const ParameterValue& value, MergeToken token) {
  const Findings because = draft_.setValue(key_, value, token);
  if (!because.empty()) emit refused(QString::fromStdString(toString(because)));
}

void PointPlot::moveSelected(QPointF by, MergeToken token) {
  hold();
  moveHeld(group(), by, token);
}

void PointPlot::mousePressEvent(QMouseEvent* event) {
  if (event->button() != Qt::LeftButton) return Plot::mousePressEvent(event);
  const bool control = event->modifiers() & Qt::ControlModifier;
  int hit = pointAt(event->position());
  if (hit < 0) {
    selectElsewhere(event->position(), control);
    hit = pointAt(event->position());
  }
  if (hit < 0 && editable()) {
    areaFrom_ = event->position().toPoint();
    area_.setGeometry(QRect(areaFrom_, QSize()));
    area_.show();
  }
  if (hit < 0 || !editable()) return Plot::mousePressEvent(event);
  if (control) return toggle(hit);
  if (selection_.has(hit)) {
    selection_.follow(hit);
    redraw();
  } else {
    select(hit);
  }
  hold();
  heldPoints_ = points();
  const EditPoint& at = heldPoints_[static_cast<std::size_t>(hit)];
  grabOffset_ = pixelOf(at.x, at.y) - event->position();
  drag_ = draft_.newToken();
  setCursor(Qt::ClosedHandCursor);
}

void PointPlot::mouseMoveEvent(QMouseEvent* event) {
  if (drag_ != 0 && selected() >= 0 && selected() < static_cast<int>(heldPoints_.size())) {
    const EditPoint& from = heldPoints_[static_cast<std::size_t>(selected())];
    const QPointF pixel = event->position() + grabOffset_, gone = pixel - pixelOf(from.x, from.y);
    QPointF to = valueAt(pixel);
    if (!(event->modifiers() & Qt::AltModifier))
      to.setX(snapped(xAxis->pixelToCoord(pixel.x())).value_or(to.x()));
    // With Shift the point keeps to one axis, the one along which it has gone farther on the screen.
    if (event->modifiers() & Qt::ShiftModifier)
      std::abs(gone.x()) > std::abs(gone.y()) ? to.setY(from.y) : to.setX(from.x);
    moveHeld(group(), to - QPointF(from.x, from.y), drag_);
    return say(event->position());
  }
  if (!area_.isHidden()) return area_.setGeometry(QRect(areaFrom_, event->position().toPoint()).normalized());
  const bool grabs = editable() && pointAt(event->position()) >= 0;
  setCursor(grabs ? Qt::OpenHandCursor : cursorElsewhere(event->position()));
  say(event->position());
  Plot::mouseMoveEvent(event);
}

void PointPlot::mouseReleaseEvent(QMouseEvent* event) {
  if (drag_ != 0 && event->button() == Qt::LeftButton) {
    drag_ = 0;
    setCursor(Qt::OpenHandCursor);
    return;
  }
  if (!area_.isHidden() && event->button() == Qt::LeftButton) {
    area_.hide();
    if (area_.width() > kClickPx || area_.height() > kClickPx)
      selectWithin(area_.geometry(), event->modifiers() & Qt::ControlModifier);
  }
  Plot::mouseReleaseEvent(event);
}

void PointPlot::mouseDoubleClickEvent(QMouseEvent* event) {
  if (event->button() != Qt::LeftButton || !axisRect()->rect().contains(event->position().toPoint())) return;
  if (pointAt(event->position()) >= 0) return emit typingAsked();
  const QPointF at = valueAt(event->position());
  insertAt(at.x(), at.y());
}

void PointPlot::insertBesideSelected() {
  const std::vector<EditPoint> points = this->points();
  if (points.size() < 2) return insertAt(xAxis->range().center(), 0.5);
  const std::size_t left = std::min(static_cast<std::size_t>(std::max(selected(), 0)), points.size() - 2);
  const EditPoint &a = points[left], &b = points[left + 1];
  const double x = (a.x + b.x) / 2;
  insertAt(finest() > 0 ? roundedTo(x, finest()) : x, withoutDust((a.y + b.y) / 2));
}

void PointPlot::removeSelected() {
  if (selected() < 0 || !editable() || !removePoints(group())) return;
  const int count = static_cast<int>(points().size());
  selection_.choose(std::min(selected(), count - 1));
  showSelection();
}

void PointPlot::nudge(double dx, double dy) {
  const std::vector<EditPoint> points = this->points();
  if (!editable() || selected() < 0 || selected() >= static_cast<int>(points.size())) return;
  const EditPoint& at = points[static_cast<std::size_t>(selected())];
  // Places that a view or a shape gave become round as soon as keys move them.
  if (at.movesX && dx != 0) dx = roundedTo(at.x + dx, keyStep() / 100) - at.x;
  if (nudge_ == 0) nudge_ = draft_.newToken();
  moveSelected({at.movesX ? dx : 0, dy}, nudge_);
}

void PointPlot::keyPressEvent(QKeyEvent* event) {
  const double times = event->modifiers() & Qt::ShiftModifier ? 10 : 1;
  switch (event->key()) {
    case Qt::Key_A:
      if (!(event->modifiers() & Qt::ControlModifier)) return Plot::keyPressEvent(event);
      return selectAll();
    case Qt::Key_Left:
      return nudge(-keyStep() * times, 0);
    case Qt::Key_Right:
      return nudge(keyStep() * times, 0);
    case Qt::Key_Up:
      return nudge(0, kMembershipStep * times);
    case Qt::Key_Down:
      return nudge(0, -kMembershipStep * times);
    case Qt::Key_Home:
      return select(0);
    case Qt::Key_End:
      return select(std::numeric_limits<int>::max());
    case Qt::Key_Return:
    case Qt::Key_Enter:
      if (selected() >= 0) emit typingAsked();
      return;
    case Qt::Key_Insert:
      return insertBesideSelected();
    case Qt::Key_Delete:
    case Qt::Key_Backspace:
      return removeSelected();
    case Qt::Key_F:
      return fitView();
    case Qt::Key_Escape:
      if (!area_.isHidden()) return area_.hide();
      if (drag_ == 0) return event->ignore();
      setCursor(Qt::ArrowCursor);
      return commit(held_, std::exchange(drag_, 0));
    default:
      return Plot::keyPressEvent(event);
  }
}

void PointPlot::keyReleaseEvent(QKeyEvent* event) {
  if (!event->isAutoRepeat()) nudge_ = 0;
  Plot::keyReleaseEvent(event);
}

bool PointPlot::focusNextPrevChild(bool next) {
  const int to = selected() + (next ? 1 : -1);
  if (!editable() || to < 0 || to >= static_cast<int>(points().size())) return Plot::focusNextPrevChild(next);
  select(to);
  return true;
}

void PointPlot::focusInEvent(QFocusEvent* event) {
  if (event->reason() == Qt::TabFocusReason) select(0);
  if (event->reason() == Qt::BacktabFocusReason) select(std::numeric_limits<int>::max());
  Plot::focusInEvent(event);
}

void PointPlot::focusOutEvent(QFocusEvent* event) {
  nudge_ = 0;
  Plot::focusOutEvent(event);
}

void PointPlot::leaveEvent(QEvent* event) {
  say(std::nullopt);
  Plot::leaveEvent(event);
}

void PointPlot::contextMenuEvent(QContextMenuEvent* event) {
  const bool byMouse = event->reason() == QContextMenuEvent::Mouse;
  const int hit = pointAt(event->pos());
  // A click on one of several selected points keeps them, so that the menu can remove them together.
  if (byMouse && hit < 0) selectElsewhere(event->pos(), true);
  if (byMouse && hit >= 0 && !selection_.has(hit)) select(hit);
  QMenu menu(this);
  addToMenu(menu);
  const QPointF here = valueAt(event->pos());
  menu.addAction(tr("Add point"), this,
                 [&] { byMouse ? insertAt(here.x(), here.y()) : insertBesideSelected(); })
      ->setEnabled(editable());
  menu.addAction(group().size() > 1 ? tr("Remove points") : tr("Remove point"), this,
                 [this] { removeSelected(); })
      ->setEnabled(editable() && selected() >= 0);
  menu.addAction(tr("Select all points"), this, &PointPlot::selectAll)->setEnabled(editable());
  menu.addSeparator();
  menu.addAction(tr("Reset “%1”").arg(fromView(findRow(key_)->label)), this, [this] { draft_.reset(key_); })
      ->setEnabled(draft_.isChanged(key_));
  menu.addAction(tr("Show all"), this, &PointPlot::fitView);
  menu.exec(event->globalPos());
}

}  // namespace trimtab::views
