// SPDX-License-Identifier: GPL-3.0-or-later
#include <QApplication>
#include <QClipboard>
#include <QContextMenuEvent>
#include <QMenu>
#include <cmath>

#include "term_plot.h"
#include "views/model/theme.h"

/// TermPlot's mouse and keyboard.
namespace trimtab::views {
namespace {

constexpr double kGrabPx = 10, kCurvePx = 7, kSnapPx = 6;
constexpr double kMembershipStep = 0.01;

/// Returns what stays between two points of a term in this view.
double gapIn(Range view) {
  return roundStep((view.high - view.low) / 2000);
}

}  // namespace

void TermPlot::select(int term, int handle) {
  if (termAt(term) == nullptr) term = -1;
  if (term < 0) handle = -1;
  const bool another = term != term_;
  term_ = term;
  const bool moved = hand_.select(handle, static_cast<int>(handles().size()));
  if (another) drawCurves();
  if (another || moved) showSelection();
}

void TermPlot::showSelection() {
  drawPoints();
  emit selectedChanged(term_, handle());
}

void TermPlot::selectWithin(const QRect& area, bool add) {
  std::vector<int> within;
  const std::vector<TermHandle> points = handles();
  for (std::size_t i = 0; i < points.size(); ++i)
    if (area.contains(pixelOf(points[i].x, points[i].y).toPoint())) within.push_back(static_cast<int>(i));
  hand_.selectThese(within, add);
  showSelection();
}

int TermPlot::handleAt(QPointF pixel) const {
  int nearest = -1;
  double best = kGrabPx;
  const std::vector<TermHandle> points = handles();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const QPointF d = pixelOf(points[i].x, points[i].y) - pixel;
    const double distance = std::hypot(d.x(), d.y());
    // At equal distance the selected one wins: it is drawn on top.
    if (distance < best || (distance == best && static_cast<int>(i) == handle())) {
      best = distance;
      nearest = static_cast<int>(i);
    }
  }
  return nearest;
}

int TermPlot::curveAt(QPointF pixel) const {
  int nearest = -1;
  double best = kCurvePx;
  for (const std::size_t line : policy_.termsOf(signal_)) {
    if (!policy_.terms()[line].sound) continue;
    const PolicyTerm& term = *policy_.terms()[line].term;
    // Steep flanks are hit from the side.
    for (double dx = -kCurvePx; dx <= kCurvePx; dx += 1) {
      const double y = membershipOf(term, xAxis->pixelToCoord(pixel.x() + dx));
      const double distance = std::hypot(dx, yAxis->coordToPixel(y) - pixel.y());
      if (distance < best) {
        best = distance;
        nearest = static_cast<int>(line);
      }
    }
  }
  return nearest;
}

double TermPlot::snapped(double x, bool toOthers) const {
  if (toOthers)
    for (const std::size_t line : policy_.termsOf(signal_)) {
      if (static_cast<int>(line) == term_) continue;
      for (const TermHandle& other : handlesOf(*policy_.terms()[line].term, view()))
        if (!other.open && std::abs(xAxis->coordToPixel(other.x) - xAxis->coordToPixel(x)) < kSnapPx)
          return other.x;
    }
  // Values are as round as the screen can show, so that no drag ends at 4987.3341 ft.
  return roundedTo(x, roundStep(xAxis->range().size() / std::max(1, axisRect()->width())));
}

void TermPlot::put(const PolicyTerm& moved, MergeToken token) {
  const PolicyTerm& term = *termAt(term_);
  if (moved == term) return;
  policy_.putTerm(static_cast<std::size_t>(term_), moved,
                  tr("Move %1").arg(QString::fromStdString(term.name)), token);
  emit dragged();
}

/// Moves the point that is followed to a place.
void TermPlot::moveTo(double x, double y, MergeToken token) {
  const PolicyTerm* term = termAt(term_);
  if (term == nullptr || handle() < 0) return;
  put(withHandleAt(*term, static_cast<std::size_t>(handle()), x, std::clamp(y, 0.0, 1.0), gapIn(view())),
      token);
}

/// Moves all selected points by as much as the first that has no room allows.
void TermPlot::moveBy(const PolicyTerm& from, double dx, double dy, MergeToken token) {
  if (termAt(term_) != nullptr) put(withHandlesMoved(from, group(), dx, dy, gapIn(view())), token);
}

void TermPlot::mousePressEvent(QMouseEvent* event) {
  if (event->button() != Qt::LeftButton) return Plot::mousePressEvent(event);
  const bool control = event->modifiers() & Qt::ControlModifier;
  int hit = handleAt(event->position());
  if (hit < 0) {
    const int curve = curveAt(event->position());
    if (curve >= 0 || !control) select(curve >= 0 ? curve : term_, -1);
    hit = curve >= 0 ? handleAt(event->position()) : -1;
  }
  if (hit < 0) {
    if (term_ >= 0) band_.begin(*event);
    return Plot::mousePressEvent(event);
  }
  if (control) {
    hand_.toggle(hit);
    return showSelection();
  }
  if (hand_.isSelected(hit)) {
    hand_.follow(hit);
    drawPoints();
  } else {
    select(term_, hit);
  }
  const TermHandle at = handles()[static_cast<std::size_t>(hit)];
  hand_.beginDrag();
  drag_ = {*termAt(term_), pixelOf(at.x, at.y) - event->position()};
  setCursor(Qt::ClosedHandCursor);
}

void TermPlot::mouseMoveEvent(QMouseEvent* event) {
  if (hand_.dragging() && handle() >= 0) {
    const QPointF to = event->position() + drag_.offset;
    const std::vector<TermHandle> from = handlesOf(drag_.start, view());
    QPointF at(snapped(xAxis->pixelToCoord(to.x()), !(event->modifiers() & Qt::AltModifier)),
               roundedTo(yAxis->pixelToCoord(to.y()), kMembershipStep));
    if (handle() >= static_cast<int>(from.size())) return;
    const TermHandle& start = from[static_cast<std::size_t>(handle())];
    if (event->modifiers() & Qt::ShiftModifier)
      at = EditHand::straightened({start.x, start.y}, at, to - pixelOf(start.x, start.y));
    if (group().size() > 1)
      moveBy(drag_.start, at.x() - start.x, at.y() - start.y, hand_.drag());
    else
      moveTo(at.x(), at.y(), hand_.drag());
    say(event->position());
    return;
  }
  if (band_.drawn()) return band_.drawTo(*event);
  setCursor(handleAt(event->position()) >= 0  ? Qt::OpenHandCursor
            : curveAt(event->position()) >= 0 ? Qt::PointingHandCursor
                                              : Qt::ArrowCursor);
  say(event->position());
  Plot::mouseMoveEvent(event);
}

void TermPlot::mouseReleaseEvent(QMouseEvent* event) {
  if (hand_.dragging() && event->button() == Qt::LeftButton) {
    hand_.endDrag();
    setCursor(Qt::OpenHandCursor);
    return;
  }
  if (band_.drawn() && event->button() == Qt::LeftButton)
    if (const auto area = band_.end()) selectWithin(*area, event->modifiers() & Qt::ControlModifier);
  Plot::mouseReleaseEvent(event);
}

void TermPlot::mouseDoubleClickEvent(QMouseEvent* event) {
  if (event->button() != Qt::LeftButton || !axisRect()->rect().contains(event->position().toPoint())) return;
  if (handleAt(event->position()) >= 0) return emit typingAsked();
  const PolicyTerm* term = termAt(term_);
  if (term == nullptr || term->shape != TermShape::points) return fitView();
  insertPoint(snapped(xAxis->pixelToCoord(event->position().x()), false),
              roundedTo(yAxis->pixelToCoord(event->position().y()), kMembershipStep));
}

void TermPlot::cancelDrag() {
  const MergeToken drag = hand_.endDrag();
  // A key may have removed the term meanwhile.
  if (termAt(term_) != nullptr)
    policy_.putTerm(static_cast<std::size_t>(term_), drag_.start, QString(), drag);
  setCursor(Qt::ArrowCursor);
}

void TermPlot::insertPoint(double x, double y) {
  const PolicyTerm* term = termAt(term_);
  if (term == nullptr) return emit addAsked();
  const auto inserted = withPoint(*term, x, y);
  if (!inserted)
    return emit refused(term->shape == TermShape::points
                            ? tr("There is no room for another point here.")
                            : tr("Only the shape “points” takes more points; choose it in Terms."));
  policy_.putTerm(static_cast<std::size_t>(term_), inserted->term, tr("Add Point"));
  select(term_, static_cast<int>(inserted->handle));
}

void TermPlot::removePoint() {
  const PolicyTerm* term = termAt(term_);
  if (term == nullptr) return;
  if (handle() < 0) return emit removeAsked();
  const std::vector<std::size_t> gone = group();
  std::optional<PolicyTerm> left = *term;
  for (std::size_t i = gone.size(); i-- > 0 && left;) left = withoutPoint(*left, gone[i]);
  if (!left)
    return emit refused(term->shape == TermShape::points ? tr("Two points stay.")
                                                         : tr("The points of this shape belong together."));
  policy_.putTerm(static_cast<std::size_t>(term_), *left,
                  gone.size() > 1 ? tr("Remove Points") : tr("Remove Point"));
  select(term_, std::min(handle(), static_cast<int>(handles().size()) - 1));
}

void TermPlot::nudge(double dx, double dy) {
  const std::vector<TermHandle> points = handles();
  if (handle() < 0 || handle() >= static_cast<int>(points.size())) return;
  const TermHandle& at = points[static_cast<std::size_t>(handle())];
  const double step = nudgeStep(view()) / 100;
  const double x = at.movesX ? roundedTo(at.x + dx, step) : at.x, y = roundedTo(at.y + dy, 1e-6);
  if (group().size() > 1)
    moveBy(*termAt(term_), x - at.x, y - at.y, hand_.nudge());
  else
    moveTo(x, y, hand_.nudge());
}

void TermPlot::selectAll() {
  hand_.selectAll(static_cast<int>(handles().size()));
  showSelection();
}

/// Moves the point to the nearest point of another term on the right (1) or left (-1).
void TermPlot::snapTo(int side) {
  const std::vector<TermHandle> points = handles();
  if (handle() < 0 || handle() >= static_cast<int>(points.size())) return;
  const TermHandle& at = points[static_cast<std::size_t>(handle())];
  double nearest = std::numeric_limits<double>::infinity();
  for (const std::size_t line : policy_.termsOf(signal_)) {
    if (static_cast<int>(line) == term_) continue;
    for (const TermHandle& other : handlesOf(*policy_.terms()[line].term, view()))
      if (const double away = side * (other.x - at.x); !other.open && away > 0)
        nearest = std::min(nearest, away);
  }
  if (!at.movesX || !std::isfinite(nearest)) return;
  const MergeToken step = policy_.draft().newToken();
  if (group().size() > 1)
    moveBy(*termAt(term_), side * nearest, 0, step);
  else
    moveTo(at.x + side * nearest, at.y, step);
}

void TermPlot::stepTerm(int by) {
  const std::vector<std::size_t> lines = policy_.termsOf(signal_);
  if (lines.empty()) return;
  const auto at = std::find(lines.begin(), lines.end(), static_cast<std::size_t>(std::max(term_, 0)));
  const auto count = static_cast<std::ptrdiff_t>(lines.size());
  const std::ptrdiff_t next = at == lines.end() ? 0 : ((at - lines.begin()) + by + count) % count;
  select(static_cast<int>(lines[static_cast<std::size_t>(next)]), 0);
}

void TermPlot::keyPressEvent(QKeyEvent* event) {
  const double times = event->modifiers() & Qt::ShiftModifier ? 10 : 1;
  const double step = nudgeStep(view()) * times / 10;
  if (event->matches(QKeySequence::Copy)) return copyShape();
  if (event->matches(QKeySequence::Paste)) return pasteShape();
  const bool control = event->modifiers() & Qt::ControlModifier;
  switch (event->key()) {
    case Qt::Key_Escape:
      if (band_.drawn()) return band_.hide();
      return hand_.dragging() ? cancelDrag() : event->ignore();
    case Qt::Key_Left:
      return control ? snapTo(-1) : nudge(-step, 0);
    case Qt::Key_Right:
      return control ? snapTo(1) : nudge(step, 0);
    case Qt::Key_Up:
      return nudge(0, kMembershipStep * times);
    case Qt::Key_Down:
      return nudge(0, -kMembershipStep * times);
    case Qt::Key_PageUp:
      return stepTerm(-1);
    case Qt::Key_PageDown:
      return stepTerm(1);
    case Qt::Key_Insert: {
      const std::vector<TermHandle> points = handles();
      if (points.size() < 2) return insertPoint(xAxis->range().center(), 0.5);
      const std::size_t left = std::min(static_cast<std::size_t>(std::max(handle(), 0)), points.size() - 2);
      return insertPoint((points[left].x + points[left + 1].x) / 2,
                         (points[left].y + points[left + 1].y) / 2);
    }
    case Qt::Key_Delete:
    case Qt::Key_Backspace:
      if (control) return emit removeAsked();
      return removePoint();
    case Qt::Key_A:
      return control ? selectAll() : emit addAsked();
    case Qt::Key_D:
      return control ? emit duplicateAsked() : event->ignore();
    case Qt::Key_Return:
    case Qt::Key_Enter:
      if (term_ >= 0) emit typingAsked();
      return;
    case Qt::Key_Home:
      return select(term_, 0);
    case Qt::Key_End:
      return select(term_, static_cast<int>(handles().size()) - 1);
    case Qt::Key_F:
      return fitView();
    default:
      return Plot::keyPressEvent(event);
  }
}

void TermPlot::keyReleaseEvent(QKeyEvent* event) {
  hand_.keyReleased(*event);
  Plot::keyReleaseEvent(event);
}

bool TermPlot::focusNextPrevChild(bool next) {
  const auto to = term_ >= 0 ? hand_.tabbedTo(next, static_cast<int>(handles().size())) : std::nullopt;
  if (!to) return Plot::focusNextPrevChild(next);
  select(term_, *to);
  return true;
}

void TermPlot::focusOutEvent(QFocusEvent* event) {
  hand_.endNudge();
  Plot::focusOutEvent(event);
}

void TermPlot::leaveEvent(QEvent* event) {
  say(std::nullopt);
  Plot::leaveEvent(event);
}

void TermPlot::say(const std::optional<QPointF>& at) {
  const bool shown = at && axisRect()->rect().contains(at->toPoint());
  if (!shown && !parts_.readout->visible()) return;
  parts_.readout->setVisible(shown);
  if (shown) {
    const std::vector<TermHandle> points = handles();
    const int grabbed = hand_.dragging() ? handle() : handleAt(*at);
    QString text;
    double x = xAxis->pixelToCoord(at->x());
    if (grabbed >= 0 && grabbed < static_cast<int>(points.size())) {
      const TermHandle& handle = points[static_cast<std::size_t>(grabbed)];
      x = handle.x;
      text = handle.name + QStringLiteral(": ");
    }
    text += signalText(signal_, x);
    for (const std::size_t line : policy_.termsOf(signal_)) {
      if (!policy_.terms()[line].sound) continue;
      const PolicyTerm& term = *policy_.terms()[line].term;
      const double mu = membershipOf(term, x);
      if (mu >= 0.005 || static_cast<int>(line) == term_)
        text += QStringLiteral("\n%1 %2").arg(QString::fromStdString(term.name), QString::number(mu, 'f', 2));
    }
    placeReadout(*parts_.readout, text, *at);
  }
  layer(QStringLiteral("hover"))->replot();
}

void TermPlot::copyShape() {
  if (const PolicyTerm* term = termAt(term_))
    QApplication::clipboard()->setText(QString::fromStdString(shapeText(*term)));
}

void TermPlot::pasteShape() {
  const PolicyTerm* term = termAt(term_);
  if (term == nullptr) return emit refused(tr("Select the term that is to get the shape."));
  auto shape = readShape(QApplication::clipboard()->text().toStdString(), "");
  if (!shape) return emit refused(tr("The clipboard holds no shape. ") + sentences(shape.findings()));
  PolicyTerm changed = *term;
  changed.shape = shape->shape;
  changed.numbers = shape->numbers;
  if (const Findings wrong = policy_.check(changed, static_cast<std::size_t>(term_)); !wrong.empty())
    return emit refused(sentences(wrong));
  policy_.putTerm(static_cast<std::size_t>(term_), changed, tr("Paste Shape"));
}

void TermPlot::contextMenuEvent(QContextMenuEvent* event) {
  if (event->reason() == QContextMenuEvent::Mouse && curveAt(event->pos()) >= 0 && handleAt(event->pos()) < 0)
    select(curveAt(event->pos()));
  QMenu menu(this);
  const auto add = [&](const QString& text, auto act, bool enabled) {
    menu.addAction(text, this, act)->setEnabled(enabled);
  };
  const PolicyTerm* term = termAt(term_);
  add(
      tr("Add term"), [this] { emit addAsked(); }, true);
  add(
      tr("Remove term"), [this] { emit removeAsked(); }, term != nullptr);
  add(
      tr("Copy shape"), [this] { copyShape(); }, term != nullptr);
  add(
      tr("Paste shape"), [this] { pasteShape(); }, term != nullptr);
  const bool points = term != nullptr && term->shape == TermShape::points;
  const QPointF at = event->pos();
  add(
      tr("Add point"),
      [this, at] {
        insertPoint(snapped(xAxis->pixelToCoord(at.x()), false),
                    roundedTo(yAxis->pixelToCoord(at.y()), kMembershipStep));
      },
      points);
  add(
      group().size() > 1 ? tr("Remove points") : tr("Remove point"), [this] { removePoint(); },
      points && handle() >= 0);
  add(
      tr("Select all points"), [this] { selectAll(); }, term != nullptr);
  menu.addSeparator();
  add(
      tr("Show all terms"), [this] { fitView(); }, true);
  menu.exec(event->globalPos());
}

}  // namespace trimtab::views
