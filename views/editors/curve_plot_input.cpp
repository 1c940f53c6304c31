// SPDX-License-Identifier: GPL-3.0-or-later
#include <QContextMenuEvent>
#include <QMenu>
#include <cmath>

#include "curve_plot.h"
#include "views/model/rounded.h"
#include "views/model/theme.h"

/// CurvePlot's mouse and keyboard.
namespace trimtab::views {

namespace {

constexpr double kGrabPx = 10;
constexpr double kMembershipStep = 0.01;

}  // namespace

void CurvePlot::showSelection() {
  redraw();
  emit selectedChanged(selected());
}

void CurvePlot::select(int index) {
  if (hand_.select(index, static_cast<int>(curve().size))) showSelection();
}

void CurvePlot::toggle(int index) {
  hand_.toggle(index);
  showSelection();
}

void CurvePlot::selectAll() {
  hand_.selectAll(static_cast<int>(curve().size));
  showSelection();
}

void CurvePlot::selectWithin(const QRect& area, bool add) {
  const CurvePoints points = curve();
  std::vector<int> within;
  for (std::size_t i = 0; i < points.size; ++i)
    if (area.contains(pixelOf(points.point[i]).toPoint())) within.push_back(static_cast<int>(i));
  hand_.selectThese(within, add);
  showSelection();
}

int CurvePlot::pointAt(QPointF pixel) const {
  int nearest = -1;
  double best = kGrabPx;
  const CurvePoints points = curve();
  for (std::size_t i = 0; i < points.size; ++i) {
    const QPointF d = pixelOf(points.point[i]) - pixel;
    const double distance = std::hypot(d.x(), d.y());
    // At equal distance the selected one wins: it is drawn on top.
    if (distance < best || (distance == best && static_cast<int>(i) == selected())) {
      best = distance;
      nearest = static_cast<int>(i);
    }
  }
  return nearest;
}

CurvePoint CurvePlot::valueAt(QPointF pixel) const {
  // Values are as round as the screen can show, so that no drag ends at 4987.3341 ft.
  const double xStep =
      std::max(pointGap(spec_), roundStep(xAxis->range().size() / std::max(1, axisRect()->width())));
  return {roundedTo(xAxis->pixelToCoord(pixel.x()), xStep),
          std::clamp(roundedTo(yAxis->pixelToCoord(pixel.y()), kMembershipStep), 0.0, 1.0)};
}

void CurvePlot::commit(const CurvePoints& changed, MergeToken token) {
  const Findings refusedBecause = draft_.setValue(spec_.key, changed, token);
  if (!refusedBecause.empty()) emit refused(QString::fromStdString(toString(refusedBecause)));
}

void CurvePlot::mousePressEvent(QMouseEvent* event) {
  const int hit = pointAt(event->position());
  if (event->button() == Qt::LeftButton && hit >= 0 && editable()) {
    if (event->modifiers() & Qt::ControlModifier) return toggle(hit);
    hand_.isSelected(hit) ? hand_.follow(hit) : select(hit);
    hand_.beginDrag();
    dragStart_ = curve();
    grabOffset_ = pixelOf(dragStart_.point[static_cast<std::size_t>(hit)]) - event->position();
    setCursor(Qt::ClosedHandCursor);
    return;
  }
  if (event->button() == Qt::LeftButton && hit < 0) {
    if (!(event->modifiers() & Qt::ControlModifier)) select(-1);
    if (editable()) band_.begin(*event);
  }
  Plot::mousePressEvent(event);
}

void CurvePlot::mouseMoveEvent(QMouseEvent* event) {
  if (hand_.dragging() && selected() >= 0) {
    CurvePoint to = valueAt(event->position() + grabOffset_);
    const CurvePoint from = dragStart_.point[static_cast<std::size_t>(selected())];
    if (event->modifiers() & Qt::ShiftModifier) {
      const QPointF kept =
          EditHand::straightened({from.x, from.y}, {to.x, to.y}, pixelOf(to) - pixelOf(from));
      to = {kept.x(), kept.y()};
    }
    const std::vector<std::size_t> moved = group();
    if (moved.size() > 1)
      commit(withAllMoved(dragStart_, moved, {to.x - from.x, to.y - from.y}, spec_), hand_.drag());
    else
      commit(withMoved(curve(), static_cast<std::size_t>(selected()), to, spec_), hand_.drag());
    drawHover(pixelOf(curve().point[static_cast<std::size_t>(selected())]));
    return;
  }
  if (band_.drawn()) return band_.drawTo(*event);
  setCursor(pointAt(event->position()) >= 0 && editable() ? Qt::OpenHandCursor : Qt::ArrowCursor);
  drawHover(event->position());
  Plot::mouseMoveEvent(event);
}

void CurvePlot::mouseReleaseEvent(QMouseEvent* event) {
  if (hand_.dragging() && event->button() == Qt::LeftButton) {
    hand_.endDrag();
    setCursor(Qt::OpenHandCursor);
    return;
  }
  if (band_.drawn() && event->button() == Qt::LeftButton)
    if (const auto area = band_.end()) selectWithin(*area, event->modifiers() & Qt::ControlModifier);
  Plot::mouseReleaseEvent(event);
}

void CurvePlot::mouseDoubleClickEvent(QMouseEvent* event) {
  if (event->button() != Qt::LeftButton) return;
  if (pointAt(event->position()) < 0 && axisRect()->rect().contains(event->position().toPoint()))
    addPoint(valueAt(event->position()));
}

void CurvePlot::cancelDrag() {
  commit(dragStart_, hand_.endDrag());
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
  const std::size_t left = std::min(static_cast<std::size_t>(std::max(selected(), 0)), points.size - 2);
  const CurvePoint a = points.point[left], b = points.point[left + 1];
  addPoint({roundedTo((a.x + b.x) / 2, pointGap(spec_)), withoutDust((a.y + b.y) / 2)});
}

void CurvePlot::removeSelected() {
  if (selected() < 0 || !editable()) return;
  const std::optional<CurvePoints> removed = withAllRemoved(curve(), group());
  if (!removed) return emit refused(tr("A curve keeps at least two points."));
  commit(*removed, 0);
  select(selected());
}

void CurvePlot::nudge(double dx, double dy) {
  if (selected() < 0 || !editable()) return;
  const CurvePoints points = curve();
  if (const std::vector<std::size_t> moved = group(); moved.size() > 1)
    return commit(withAllMoved(points, moved, {dx, dy}, spec_), hand_.nudge());
  const CurvePoint from = points.point[static_cast<std::size_t>(selected())];
  commit(withMoved(points, static_cast<std::size_t>(selected()),
                   {withoutDust(from.x + dx), withoutDust(from.y + dy)}, spec_),
         hand_.nudge());
}

void CurvePlot::keyPressEvent(QKeyEvent* event) {
  const double times = event->modifiers() & Qt::ShiftModifier ? 10 : 1;
  const double xStep = std::max(findRow(spec_.key)->step, pointGap(spec_)) * times;
  switch (event->key()) {
    case Qt::Key_A:
      if (!(event->modifiers() & Qt::ControlModifier)) return Plot::keyPressEvent(event);
      return selectAll();
    case Qt::Key_Left:
      return nudge(-xStep, 0);
    case Qt::Key_Right:
      return nudge(xStep, 0);
    case Qt::Key_Up:
      return nudge(0, kMembershipStep * times);
    case Qt::Key_Down:
      return nudge(0, -kMembershipStep * times);
    case Qt::Key_Home:
      return select(0);
    case Qt::Key_End:
      return select(static_cast<int>(curve().size) - 1);
    default:
      break;
  }
  switch (EditHand::commandOf(*event)) {
    case EditHand::Command::type:
      if (selected() >= 0) emit typingAsked();
      return;
    case EditHand::Command::add:
      return addPointBesideSelected();
    case EditHand::Command::remove:
      return removeSelected();
    case EditHand::Command::cancel:
      if (band_.drawn()) return band_.hide();
      return hand_.dragging() ? cancelDrag() : event->ignore();
    case EditHand::Command::none:
      return Plot::keyPressEvent(event);
  }
}

void CurvePlot::keyReleaseEvent(QKeyEvent* event) {
  hand_.keyReleased(*event);
  Plot::keyReleaseEvent(event);
}

bool CurvePlot::focusNextPrevChild(bool next) {
  const auto to = editable() ? hand_.tabbedTo(next, static_cast<int>(curve().size)) : std::nullopt;
  if (!to) return Plot::focusNextPrevChild(next);
  select(*to);
  return true;
}

void CurvePlot::focusInEvent(QFocusEvent* event) {
  if (const auto at = EditHand::enteredAt(event->reason(), static_cast<int>(curve().size))) select(*at);
  Plot::focusInEvent(event);
}

void CurvePlot::focusOutEvent(QFocusEvent* event) {
  hand_.endNudge();
  Plot::focusOutEvent(event);
}

void CurvePlot::leaveEvent(QEvent* event) {
  drawHover(std::nullopt);
  Plot::leaveEvent(event);
}

void CurvePlot::contextMenuEvent(QContextMenuEvent* event) {
  const bool byMouse = event->reason() == QContextMenuEvent::Mouse;
  const int hit = pointAt(event->pos());
  // A click on one of several selected points keeps them, so that the menu can remove them together.
  if (byMouse && hit >= 0 && !hand_.isSelected(hit)) select(hit);
  QMenu menu(this);
  const CurvePoint here = valueAt(event->pos());
  QAction* add =
      menu.addAction(tr("Add point"), this, [&] { byMouse ? addPoint(here) : addPointBesideSelected(); });
  add->setEnabled(editable() && curve().size < CurvePoints::kCapacity);
  QAction* remove = menu.addAction(group().size() > 1 ? tr("Remove points") : tr("Remove point"), this,
                                   &CurvePlot::removeSelected);
  remove->setEnabled(editable() && selected() >= 0 && curve().size > 2);
  menu.addAction(tr("Select all points"), this, &CurvePlot::selectAll)->setEnabled(editable());
  menu.addSeparator();
  QAction* reset = menu.addAction(tr("Reset this curve"), this, [this] { draft_.reset(spec_.key); });
  reset->setEnabled(draft_.isChanged(spec_.key));
  menu.addAction(tr("Show all points"), this, &CurvePlot::fitView);
  menu.exec(event->globalPos());
}

}  // namespace trimtab::views
