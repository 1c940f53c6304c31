// SPDX-License-Identifier: GPL-3.0-or-later
#include "band_scale.h"

#include <QContextMenuEvent>
#include <QMenu>
#include <QPainter>
#include <algorithm>
#include <cmath>

#include "views/model/keys.h"
#include "views/model/rounded.h"
#include "views/model/theme.h"
#include "views/plots/ghosts.h"

namespace trimtab::views {

namespace {
constexpr double kGrabPx = 8;
}  // namespace

BandScale::BandScale(Draft& draft, QWidget* parent)
    : QWidget(parent), draft_(draft), hand_(draft), throttle_(this, [this] { update(); }) {
  setFocusPolicy(Qt::StrongFocus);
  setMouseTracking(true);
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
  setAccessibleName(tr("Depth-map bands by total membership"));
  setAccessibleDescription(
      tr("Tab selects a band edge, arrow keys move it (Shift: ten times as far), Insert splits a band, "
         "Delete removes one."));
  connect(&draft_, &Draft::valueChanged, this, [this](const QString& key) {
    if (key.toStdString() == key::kBands && selected() >= static_cast<int>(bands().size))
      select(static_cast<int>(bands().size) - 1);
  });
  connect(&draft_, &Draft::findingsChanged, this, qOverload<>(&QWidget::update));
  connect(&draft_, &Draft::referencesChanged, this, qOverload<>(&QWidget::update));
}

BandList BandScale::bands() const {
  return std::get<BandList>(draft_.value(key::kBands));
}

QSize BandScale::sizeHint() const {
  return {360, fontMetrics().height() * 5 + 22};
}
QSize BandScale::minimumSizeHint() const {
  return {200, sizeHint().height()};
}

/// The live label is above the track, and the tick labels are below it.
QRectF BandScale::track() const {
  const double line = fontMetrics().height();
  return {10, line + 10, width() - 20.0, 2.6 * line};
}
QPointF BandScale::pixelOf(double total) const {
  const QRectF t = track();
  return {t.left() + t.width() * total / BandList::kTop, t.center().y()};
}
double BandScale::totalAt(double x) const {
  const QRectF t = track();
  return std::clamp((x - t.left()) / t.width() * BandList::kTop, 0.0, BandList::kTop);
}

int BandScale::edgeAt(QPointF pixel) const {
  const BandList list = bands();
  int nearest = -1;
  double best = kGrabPx;
  if (!track().adjusted(-kGrabPx, -6, kGrabPx, 6).contains(pixel)) return -1;
  for (std::size_t i = 0; i < list.size; ++i)
    if (const double d = std::abs(pixelOf(list.band[i].low).x() - pixel.x()); d < best) {
      best = d;
      nearest = static_cast<int>(i);
    }
  return nearest;
}

int BandScale::bandAt(double total) const {
  const BandList list = bands();
  int band = -1;
  while (band + 1 < static_cast<int>(list.size) && list.band[static_cast<std::size_t>(band + 1)].low <= total)
    ++band;
  return band;
}

void BandScale::showFrame(const LiveFrame& frame) {
  total_ = frame.decision.totalMembership;
  liveBand_ = frame.decision.band;
  throttle_.request();
}

void BandScale::select(int index) {
  if (!hand_.select(index, static_cast<int>(bands().size))) return;
  update();
  emit selectedChanged(selected());
}

void BandScale::commit(const BandList& changed, MergeToken token) {
  const Findings because = draft_.setValue(key::kBands, changed, token);
  if (!because.empty()) emit refused(QString::fromStdString(toString(because)));
}

void BandScale::addBand(double low) {
  const std::optional<InsertedBand> inserted = withBand(bands(), low);
  if (!inserted)
    return emit refused(tr("There is no room for another band here (at most %1).").arg(BandList::kCapacity));
  commit(inserted->bands, 0);
  select(static_cast<int>(inserted->index));
}

void BandScale::addBandInSelected() {
  const BandList list = bands();
  if (list.size == 0) return addBand(1);
  const std::size_t at =
      static_cast<std::size_t>(selected() < 0 ? static_cast<int>(list.size) - 1 : selected());
  addBand(roundedTo((list.band[at].low + highOf(list, at)) / 2, kEdgeGap));
}

void BandScale::removeSelected() {
  if (selected() < 0) return;
  const std::optional<BandList> removed = withoutBand(bands(), static_cast<std::size_t>(selected()));
  if (!removed) return emit refused(tr("One band stays."));
  commit(*removed, 0);
}

void BandScale::mousePressEvent(QMouseEvent* event) {
  if (event->button() != Qt::LeftButton) return;
  const int edge = edgeAt(event->position());
  if (edge < 0) return select(bandAt(totalAt(event->position().x())));
  select(edge);
  hand_.beginDrag();
  dragStart_ = bands();
}

void BandScale::mouseMoveEvent(QMouseEvent* event) {
  if (hand_.dragging() && selected() >= 0)
    return commit(withEdge(bands(), static_cast<std::size_t>(selected()),
                           roundedTo(totalAt(event->position().x()), kEdgeGap)),
                  hand_.drag());
  setCursor(edgeAt(event->position()) >= 0 ? Qt::SplitHCursor : Qt::ArrowCursor);
  const double total = totalAt(event->position().x());
  const int band = bandAt(total);
  const BandList list = bands();
  const QString here = band < 0
                           ? tr("Total membership %1: view-frustum culling alone").arg(numberText(total, 2))
                           : tr("Total membership %1: depth map %2 × %3 px")
                                 .arg(numberText(total, 2))
                                 .arg(list.band[static_cast<std::size_t>(band)].widthPx)
                                 .arg(list.band[static_cast<std::size_t>(band)].heightPx);
  setToolTip(here + ghostsText());
}

void BandScale::mouseReleaseEvent(QMouseEvent*) {
  hand_.endDrag();
}

void BandScale::mouseDoubleClickEvent(QMouseEvent* event) {
  if (event->button() == Qt::LeftButton && edgeAt(event->position()) < 0 &&
      track().contains(event->position()))
    addBand(roundedTo(totalAt(event->position().x()), kEdgeGap));
}

void BandScale::contextMenuEvent(QContextMenuEvent* event) {
  const double here = roundedTo(totalAt(event->pos().x()), kEdgeGap);
  const bool byMouse = event->reason() == QContextMenuEvent::Mouse;
  if (byMouse) select(bandAt(here));
  QMenu menu(this);
  menu.addAction(tr("Split band here"), this, [&] { byMouse ? addBand(here) : addBandInSelected(); });
  menu.addAction(tr("Remove band"), this, &BandScale::removeSelected)
      ->setEnabled(selected() >= 0 && bands().size > 1);
  menu.addSeparator();
  menu.addAction(tr("Reset the bands"), this, [this] { draft_.reset(key::kBands); })
      ->setEnabled(draft_.isChanged(key::kBands));
  menu.exec(event->globalPos());
}

void BandScale::keyPressEvent(QKeyEvent* event) {
  const double step = event->modifiers() & Qt::ShiftModifier ? 10 * kEdgeGap : kEdgeGap;
  const auto nudge = [&](double by) {
    if (selected() < 0) return;
    const std::size_t at = static_cast<std::size_t>(selected());
    commit(withEdge(bands(), at, roundedTo(bands().band[at].low + by, kEdgeGap)), hand_.nudge());
  };
  switch (event->key()) {
    case Qt::Key_Left:
    case Qt::Key_Down:
      return nudge(-step);
    case Qt::Key_Right:
    case Qt::Key_Up:
      return nudge(step);
    default:
      break;
  }
  switch (EditHand::commandOf(*event)) {
    case EditHand::Command::type:
      if (selected() >= 0) emit typingAsked();
      return;
    case EditHand::Command::add:
      return addBandInSelected();
    case EditHand::Command::remove:
      return removeSelected();
    case EditHand::Command::cancel:
      return hand_.dragging() ? commit(dragStart_, hand_.endDrag()) : event->ignore();
    case EditHand::Command::none:
      return QWidget::keyPressEvent(event);
  }
}

void BandScale::keyReleaseEvent(QKeyEvent* event) {
  hand_.keyReleased(*event);
  QWidget::keyReleaseEvent(event);
}

bool BandScale::focusNextPrevChild(bool next) {
  const auto to = hand_.tabbedTo(next, static_cast<int>(bands().size));
  if (!to) return QWidget::focusNextPrevChild(next);
  select(*to);
  return true;
}

void BandScale::focusInEvent(QFocusEvent* event) {
  if (const auto at = EditHand::enteredAt(event->reason(), static_cast<int>(bands().size))) select(*at);
  update();
}

void BandScale::focusOutEvent(QFocusEvent*) {
  hand_.endNudge();
  update();
}

void BandScale::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  paintBands(painter);
  paintGhosts(painter);
  paintEdges(painter);
  paintLive(painter);
  painter.end();
  paintFocusFrame(*this);
}

void BandScale::paintBands(QPainter& painter) {
  const BandList list = bands();
  const QRectF t = track();
  const QColor base = palette().color(QPalette::Base), ink = palette().color(QPalette::Text);
  const QColor band = seriesColour(0, palette());
  for (int i = -1; i < static_cast<int>(list.size); ++i) {
    const double low = i < 0 ? 0 : list.band[static_cast<std::size_t>(i)].low;
    const double high = i < 0 ? (list.size > 0 ? list.band[0].low : BandList::kTop)
                              : highOf(list, static_cast<std::size_t>(i));
    const QRectF cell(QPointF(pixelOf(low).x(), t.top()), QPointF(pixelOf(high).x(), t.bottom()));
    const bool live = total_ && i == liveBand_;
    const double depth = list.size > 0 ? 0.10 + 0.30 * (i + 1) / static_cast<double>(list.size) : 0.1;
    painter.fillRect(cell, i < 0 ? blend(base, ink, 0.06) : blend(base, band, depth));
    if (live)
      painter.fillRect(QRectF(cell.left(), cell.bottom() - 4, cell.width(), 4), liveColour(palette()));
    QString text = i < 0 ? tr("frustum")
                         : QStringLiteral("%1×%2")
                               .arg(list.band[static_cast<std::size_t>(i)].widthPx)
                               .arg(list.band[static_cast<std::size_t>(i)].heightPx);
    QFont font = this->font();
    font.setBold(live);
    painter.setFont(font);
    painter.setPen(ink);
    const QFontMetrics metrics(font);
    if (metrics.horizontalAdvance(text) < cell.width() - 4) {
      painter.drawText(cell, Qt::AlignCenter, text);
    } else if (metrics.height() < cell.width()) {
      // The text of a narrow cell runs upward.
      painter.save();
      painter.translate(cell.center());
      painter.rotate(-90);
      font.setPointSizeF(font.pointSizeF() * 0.75);
      painter.setFont(font);
      painter.drawText(QRectF(-cell.height() / 2, -cell.width() / 2, cell.height(), cell.width()),
                       Qt::AlignCenter, text);
      painter.restore();
    }
  }
  painter.setPen(blend(base, ink, 0.5));
  painter.drawRect(t);
}

/// Draws the edges of the file and of a pinned snapshot, if the draft has others.
void BandScale::paintGhosts(QPainter& painter) {
  const QRectF t = track();
  for (const Reference which : kGhosts) {
    if (!draft_.isChanged(key::kBands, which)) continue;
    painter.setPen(ghostPen(which, palette()));
    const ParameterValue list = findRow(key::kBands)->get(*draft_.reference(which));
    for (const Band& band : std::get<BandList>(list).span()) {
      const double x = pixelOf(band.low).x();
      painter.drawLine(QPointF(x, t.top() - 5), QPointF(x, t.bottom() + 5));
    }
  }
}

QString BandScale::ghostsText() const {
  QString text;
  for (const Reference which : kGhosts) {
    if (!draft_.isChanged(key::kBands, which)) continue;
    QStringList edges;
    const ParameterValue list = findRow(key::kBands)->get(*draft_.reference(which));
    for (const Band& band : std::get<BandList>(list).span()) edges << numberText(band.low, 3);
    text +=
        QLatin1Char('\n') + (which == Reference::pinned ? tr("Dash-dotted, %1: %2") : tr("Dotted, %1: %2"))
                                .arg(ghostName(which, draft_), edges.join(QStringLiteral(", ")));
  }
  return text;
}

void BandScale::paintEdges(QPainter& painter) {
  const BandList list = bands();
  const QRectF t = track();
  const QColor base = palette().color(QPalette::Base), ink = palette().color(QPalette::Text);
  const double hysteresis = std::get<double>(draft_.value(key::kHysteresis));
  const bool broken = draft_.isBroken() && !(draft_.findingsOf(key::kBands).empty() &&
                                             draft_.findingsOf(key::kHysteresis).empty());
  QColor zone = broken ? errorColour(palette()) : ink;
  zone.setAlpha(70);
  painter.setFont(font());
  double lastLabel = -1e9;
  const auto label = [&](double value, const QColor& colour) {
    const QString text = numberText(value, 3);
    const double width = fontMetrics().horizontalAdvance(text), x = pixelOf(value).x() - width / 2;
    const double left = std::clamp(x, 0.0, this->width() - width);
    if (left < lastLabel + 4) return;
    lastLabel = left + width;
    painter.setPen(colour);
    painter.drawText(QPointF(left, t.bottom() + 8 + fontMetrics().ascent()), text);
  };
  label(0, quietColour(palette()));
  for (std::size_t i = 0; i < list.size; ++i) {
    const double low = list.band[i].low, x = pixelOf(low).x();
    if (hysteresis > 0) {
      const double left = pixelOf(std::max(0.0, low - hysteresis)).x(),
                   right = pixelOf(std::min(BandList::kTop, low + hysteresis)).x();
      painter.fillRect(QRectF(left, t.top(), right - left, t.height()), QBrush(zone, Qt::BDiagPattern));
    }
    const bool chosen = static_cast<int>(i) == selected();
    painter.setPen(QPen(broken ? errorColour(palette()) : ink, chosen ? 3 : 1.6));
    painter.drawLine(QPointF(x, t.top() - 3), QPointF(x, t.bottom() + 3));
    painter.setBrush(chosen ? palette().color(QPalette::Highlight) : base);
    painter.setPen(QPen(ink, chosen && hasFocus() ? 2 : 1));
    painter.drawRect(QRectF(x - 4, t.center().y() - 8, 8, 16));
    label(low, ink);
  }
  label(BandList::kTop, quietColour(palette()));
}

void BandScale::paintLive(QPainter& painter) {
  if (!total_ || !std::isfinite(*total_)) return;
  const QRectF t = track();
  const double x = pixelOf(std::clamp(*total_, 0.0, BandList::kTop)).x();
  const QColor live = liveColour(palette());
  painter.setPen(QPen(live, 2));
  painter.drawLine(QPointF(x, t.top() - 2), QPointF(x, t.bottom()));
  painter.setBrush(live);
  painter.setPen(Qt::NoPen);
  painter.drawPolygon(
      QPolygonF({QPointF(x - 6, t.top() - 9), QPointF(x + 6, t.top() - 9), QPointF(x, t.top() - 1)}));
  const QString text = tr("total %1").arg(numberText(*total_, 3));
  const double width = fontMetrics().horizontalAdvance(text);
  painter.setPen(palette().color(QPalette::WindowText));
  painter.drawText(QPointF(std::clamp(x - width / 2, 0.0, this->width() - width), fontMetrics().ascent()),
                   text);
}

}  // namespace trimtab::views
