// SPDX-License-Identifier: GPL-3.0-or-later
#include <QApplication>
#include <QClipboard>
#include <QMenu>
#include <algorithm>
#include <cmath>

#include "term_plot.h"
#include "views/model/rounded.h"
#include "views/model/theme.h"

/// What moving, adding and removing points does to the term of a TermPlot, and what a person can do to whole
/// terms.
namespace trimtab::views {
namespace {

constexpr double kCurvePx = 7, kSnapPx = 6;

/// Returns what stays between two points of a term in this view.
double gapIn(Range view) {
  return roundStep((view.high - view.low) / 2000);
}

}  // namespace

void TermPlot::selectTerm(int term, int point) {
  if (termAt(term) == nullptr) term = -1;
  if (term != term_) {
    term_ = term;
    forgetSelection();
    if (point < 0 || points().empty()) return showSelection();
  }
  select(point);
}

bool TermPlot::hasPoints() const {
  const PolicyTerm* term = termAt(term_);
  return term != nullptr && term->shape == TermShape::points;
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

void TermPlot::selectElsewhere(QPointF pixel, bool control) {
  const int curve = curveAt(pixel);
  if (curve >= 0 || !control) selectTerm(curve >= 0 ? curve : term_, -1);
}

Qt::CursorShape TermPlot::cursorElsewhere(QPointF pixel) const {
  return curveAt(pixel) >= 0 ? Qt::PointingHandCursor : Qt::ArrowCursor;
}

/// Returns where the points of the signal's other terms are.
std::vector<double> TermPlot::othersX() const {
  std::vector<double> x;
  for (const std::size_t line : policy_.termsOf(signal_)) {
    if (static_cast<int>(line) == term_) continue;
    for (const EditPoint& other : handlesOf(*policy_.terms()[line].term, view()))
      if (!other.open) x.push_back(other.x);
  }
  return x;
}

std::optional<double> TermPlot::snapped(double x) const {
  for (const double other : othersX())
    if (std::abs(xAxis->coordToPixel(other) - xAxis->coordToPixel(x)) < kSnapPx) return other;
  return std::nullopt;
}

void TermPlot::put(const PolicyTerm& term, const QString& undoText, MergeToken token) {
  policy_.putTerm(static_cast<std::size_t>(term_), term, undoText, token);
}

void TermPlot::hold() {
  PointPlot::hold();
  heldTerm_ = *termAt(term_);
}

void TermPlot::moveHeld(const std::vector<std::size_t>& moved, QPointF by, MergeToken token) {
  const PolicyTerm* term = termAt(term_);
  if (term == nullptr) return;
  const PolicyTerm to = withHandlesMoved(heldTerm_, moved, by.x(), by.y(), gapIn(view()), view());
  if (to == *term) return;
  put(to, tr("Move %1").arg(QString::fromStdString(term->name)), token);
  emit dragged();
}

void TermPlot::mouseDoubleClickEvent(QMouseEvent* event) {
  if (event->button() == Qt::LeftButton && !hasPoints() && pointAt(event->position()) < 0) return fitView();
  PointPlot::mouseDoubleClickEvent(event);
}

void TermPlot::insertAt(double x, double y) {
  const PolicyTerm* term = termAt(term_);
  if (term == nullptr) return emit addAsked();
  const auto inserted = withPoint(*term, x, y);
  if (!inserted)
    return emit refused(hasPoints() ? tr("There is no room for another point here.")
                                    : tr("Only the shape “points” takes more points; choose it in Terms."));
  put(inserted->term, tr("Add Point"));
  select(static_cast<int>(inserted->handle));
}

void TermPlot::removeSelected() {
  if (editable() && selected() < 0) return emit removeAsked();
  PointPlot::removeSelected();
}

bool TermPlot::removePoints(const std::vector<std::size_t>& gone) {
  std::optional<PolicyTerm> left = *termAt(term_);
  for (std::size_t i = gone.size(); i-- > 0 && left;) left = withoutPoint(*left, gone[i]);
  if (left)
    put(*left, gone.size() > 1 ? tr("Remove Points") : tr("Remove Point"));
  else
    emit refused(hasPoints() ? tr("Two points stay.") : tr("The points of this shape belong together."));
  return left.has_value();
}

/// Moves the point to the nearest point of another term on the right (1) or left (-1).
void TermPlot::snapTo(int side) {
  if (selected() < 0) return;
  const EditPoint at = points()[static_cast<std::size_t>(selected())];
  double nearest = std::numeric_limits<double>::infinity();
  for (const double other : othersX())
    if (const double away = side * (other - at.x); away > 0) nearest = std::min(nearest, away);
  if (at.movesX && std::isfinite(nearest)) moveSelected({side * nearest, 0}, draft().newToken());
}

void TermPlot::stepTerm(int by) {
  const std::vector<std::size_t> lines = policy_.termsOf(signal_);
  if (lines.empty()) return;
  const auto at = std::ranges::find(lines, static_cast<std::size_t>(std::max(term_, 0)));
  const auto count = static_cast<std::ptrdiff_t>(lines.size());
  const std::ptrdiff_t next = at == lines.end() ? 0 : ((at - lines.begin()) + by + count) % count;
  selectTerm(static_cast<int>(lines[static_cast<std::size_t>(next)]), 0);
}

void TermPlot::keyPressEvent(QKeyEvent* event) {
  if (event->matches(QKeySequence::Copy)) return copyShape();
  if (event->matches(QKeySequence::Paste)) return pasteShape();
  const bool control = event->modifiers() & Qt::ControlModifier;
  switch (event->key()) {
    case Qt::Key_Left:
    case Qt::Key_Right:
      if (!control) break;
      return snapTo(event->key() == Qt::Key_Left ? -1 : 1);
    case Qt::Key_PageUp:
      return stepTerm(-1);
    case Qt::Key_PageDown:
      return stepTerm(1);
    case Qt::Key_Delete:
    case Qt::Key_Backspace:
      if (!control) break;
      endDrag();
      return emit removeAsked();
    case Qt::Key_A:
      if (control) break;
      return emit addAsked();
    case Qt::Key_D:
      return control ? emit duplicateAsked() : event->ignore();
    case Qt::Key_Return:
    case Qt::Key_Enter:
      if (term_ >= 0) emit typingAsked();
      return;
    default:
      break;
  }
  PointPlot::keyPressEvent(event);
}

QString TermPlot::readoutOf(double x, int point) const {
  QString text;
  if (point >= 0) text = points()[static_cast<std::size_t>(point)].name + QStringLiteral(": ");
  text += signalText(signal_, x);
  for (const std::size_t line : policy_.termsOf(signal_)) {
    if (!policy_.terms()[line].sound) continue;
    const PolicyTerm& term = *policy_.terms()[line].term;
    const double mu = membershipOf(term, x);
    if (mu >= 0.005 || static_cast<int>(line) == term_)
      text += QStringLiteral("\n%1 %2").arg(QString::fromStdString(term.name), QString::number(mu, 'f', 2));
  }
  return text;
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
  put(changed, tr("Paste Shape"));
}

void TermPlot::addToMenu(QMenu& menu) {
  const bool any = editable();
  menu.addAction(tr("Add term"), this, &TermPlot::addAsked);
  menu.addAction(tr("Remove term"), this, &TermPlot::removeAsked)->setEnabled(any);
  menu.addAction(tr("Copy shape"), this, &TermPlot::copyShape)->setEnabled(any);
  menu.addAction(tr("Paste shape"), this, &TermPlot::pasteShape)->setEnabled(any);
  menu.addSeparator();
}

}  // namespace trimtab::views
