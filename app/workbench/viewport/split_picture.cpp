// SPDX-License-Identifier: GPL-3.0-or-later
#include "split_picture.h"

#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>
#include <algorithm>
#include <cmath>
#include <utility>

#include "views/model/theme.h"

namespace trimtab::workbench {
namespace {

constexpr double kNudge = 0.01, kLeap = 0.1;
constexpr int kPaneGapPx = 4, kHandlePx = 9, kMarginPx = 6;

QString colourText(QRgb colour) {
  return QStringLiteral("%1 %2 %3").arg(qRed(colour)).arg(qGreen(colour)).arg(qBlue(colour));
}

}  // namespace

SplitPicture::SplitPicture(QWidget* parent) : QWidget(parent) {
  setFocusPolicy(Qt::StrongFocus);
  setMouseTracking(true);
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Expanding);
  setAccessibleName(tr("Two presets on one frame"));
  describe();
}

void SplitPicture::layOverParent() {
  over_ = true;
  setAttribute(Qt::WA_NativeWindow);  // the viewport would cover any other (GlWidget)
  // A click means the view below; the divider is reached by the tabulator key.
  setFocusPolicy(Qt::TabFocus);
  parentWidget()->installEventFilter(this);
  setGeometry(parentWidget()->rect());
  cover();
}

/// Over its parent, whose window lies below this one, this is as large as what it shows.
void SplitPicture::cover() {
  if (!over_) return;
  if (seesThrough())
    setMask(plateRect(oldText_, Qt::TopRightCorner, rect()));
  else
    clearMask();
}

bool SplitPicture::eventFilter(QObject* watched, QEvent* event) {
  if (watched == parentWidget() && event->type() == QEvent::Resize) {
    setGeometry(parentWidget()->rect());
    cover();
  }
  return QWidget::eventFilter(watched, event);
}

void SplitPicture::describe() {
  setAccessibleDescription(
      tr("%1 to the left of %2 %, %3 to the right. Left and right move the divider, with "
         "Shift ten times as far.")
          .arg(names_[0])
          .arg(std::lround(divider_ * 100))
          .arg(names_[1]));
  update();
}

void SplitPicture::show(ComparedImages compared) {
  compared_ = std::move(compared);
  cover();
  describe();
}

void SplitPicture::setOld(bool old, const QString& text) {
  if (old == old_ && text == oldText_) return;
  old_ = old;
  oldText_ = text;
  cover();
  update();
}

void SplitPicture::setNames(const QString& left, const QString& right) {
  names_ = {left, right};
  describe();
}

void SplitPicture::setForm(Form form) {
  form_ = form;
  describe();
}

void SplitPicture::setDivider(double share) {
  divider_ = std::clamp(share, 0.0, 1.0);
  describe();
}

QRect SplitPicture::pictureRect(const QRect& within) const {
  QRect rect({}, compared_.images[0].size().scaled(within.size(), Qt::KeepAspectRatio));
  rect.moveCenter(within.center());
  return rect;
}

int SplitPicture::dividerX() const {
  const QRect whole = pictureRect(rect());
  return whole.left() + int(std::lround(whole.width() * divider_));
}

std::vector<SplitPicture::Part> SplitPicture::parts() const {
  const QRect whole = pictureRect(rect());
  const auto& [a, b] = compared_.images;
  switch (form_) {
    case Form::left:
      return {{&a, whole, whole, names_[0]}};
    case Form::right:
      return {{&b, whole, whole, names_[1]}};
    case Form::difference:
      return {{&compared_.map, whole, whole, tr("FLIP: %1 against %2").arg(names_[0], names_[1])}};
    case Form::beside: {
      const int half = (width() - kPaneGapPx) / 2;
      const QRect first = pictureRect({0, 0, half, height()}),
                  second = pictureRect({half + kPaneGapPx, 0, half, height()});
      return {{&a, first, first, names_[0]}, {&b, second, second, names_[1]}};
    }
    case Form::divided:
      break;
  }
  const int at = dividerX();
  return {{&a, whole, {whole.topLeft(), QPoint(at - 1, whole.bottom())}, names_[0]},
          {&b, whole, {QPoint(at, whole.top()), whole.bottomRight()}, names_[1]}};
}

QRect SplitPicture::plateRect(const QString& text, Qt::Corner corner, const QRect& within) const {
  const QFontMetrics metrics(font());
  const QString fits = metrics.elidedText(text, Qt::ElideRight, within.width() - 4 * kMarginPx);
  QRect box(QPoint(), QSize(metrics.horizontalAdvance(fits) + 12, metrics.height() + 6));
  const QRect inner = within.adjusted(kMarginPx, kMarginPx, -kMarginPx, -kMarginPx);
  if (corner == Qt::TopLeftCorner) box.moveTopLeft(inner.topLeft());
  if (corner == Qt::TopRightCorner) box.moveTopRight(inner.topRight());
  if (corner == Qt::BottomRightCorner) box.moveBottomRight(inner.bottomRight());
  return box;
}

void SplitPicture::paintPlate(QPainter& painter, const QString& text, Qt::Corner corner,
                              const QRect& within) const {
  if (text.isEmpty()) return;
  const QRect box = plateRect(text, corner, within);
  painter.fillRect(box, QColor(0, 0, 0, 190));
  painter.setPen(Qt::white);
  painter.drawText(box, Qt::AlignCenter,
                   QFontMetrics(font()).elidedText(text, Qt::ElideRight, within.width() - 4 * kMarginPx));
}

void SplitPicture::paintDivider(QPainter& painter) const {
  const QRect whole = pictureRect(rect());
  const int x = dividerX();
  for (const auto& [colour, wide] : {std::pair{Qt::black, 4}, {Qt::white, 2}}) {
    painter.setPen(QPen(colour, wide));
    painter.drawLine(x, whole.top(), x, whole.bottom());
  }
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setBrush(Qt::white);
  painter.setPen(Qt::black);
  painter.drawEllipse(QPoint(x, whole.center().y()), kHandlePx, kHandlePx);
}

void SplitPicture::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  if (seesThrough()) return paintPlate(painter, oldText_, Qt::TopRightCorner, rect());
  painter.fillRect(rect(), over_ ? QColor(Qt::black) : palette().color(QPalette::Base));
  if (empty()) {
    painter.setPen(palette().color(QPalette::Text));
    painter.drawText(rect(), Qt::AlignCenter | Qt::TextWordWrap,
                     tr("The images appear here as soon as they are drawn."));
    return views::paintFocusFrame(*this);
  }
  painter.setRenderHint(QPainter::SmoothPixmapTransform);
  bool first = true;
  for (const Part& part : parts()) {
    painter.setClipRect(part.seen);
    painter.drawImage(part.whole, *part.image);
    const bool right = form_ == Form::divided && !std::exchange(first, false);
    paintPlate(painter, part.name, right ? Qt::TopRightCorner : Qt::TopLeftCorner, part.seen);
  }
  painter.setClipping(false);
  if (form_ == Form::divided) paintDivider(painter);
  paintPlate(painter, pointerText(), Qt::BottomRightCorner, rect());
  views::paintFocusFrame(*this);
}

std::optional<QPoint> SplitPicture::pixelAt(QPointF place) const {
  if (empty() || seesThrough()) return std::nullopt;
  const QSize size = compared_.images[0].size();
  for (const Part& part : parts()) {
    if (!part.seen.contains(place.toPoint())) continue;
    const QPointF at = place - part.whole.topLeft();
    return QPoint(std::clamp(int(at.x() * size.width() / part.whole.width()), 0, size.width() - 1),
                  std::clamp(int(at.y() * size.height() / part.whole.height()), 0, size.height() - 1));
  }
  return std::nullopt;
}

QString SplitPicture::valuesAt(QPointF place) const {
  const std::optional<QPoint> at = pixelAt(place);
  if (!at) return {};
  const auto& [a, b] = compared_.images;
  QString text = tr("pixel %1, %2:  %3  %4;  %5  %6")
                     .arg(at->x())
                     .arg(at->y())
                     .arg(names_[0], colourText(a.pixel(*at)), names_[1], colourText(b.pixel(*at)));
  const std::size_t index =
      std::size_t(a.height() - 1 - at->y()) * std::size_t(a.width()) + std::size_t(at->x());
  if (index < compared_.flip.size())
    text += tr(";  FLIP %1").arg(views::numberText(double(compared_.flip[index]), 3));
  return text;
}

QString SplitPicture::pointerText() const {
  return pointer_ ? valuesAt(*pointer_) : QString();
}

bool SplitPicture::nearDivider(QPointF place) const {
  return form_ == Form::divided && !empty() && !seesThrough() &&
         (!over_ || std::abs(place.x() - dividerX()) <= kHandlePx);
}

void SplitPicture::mousePressEvent(QMouseEvent* event) {
  dragging_ = event->button() == Qt::LeftButton && nearDivider(event->position());
  if (!dragging_) return event->setAccepted(!over_);
  setFocus(Qt::MouseFocusReason);
  mouseMoveEvent(event);
}

void SplitPicture::mouseMoveEvent(QMouseEvent* event) {
  const QString before = pointerText();
  pointer_ = event->position();
  setCursor(dragging_ || nearDivider(*pointer_) ? Qt::SplitHCursor
            : over_                             ? parentWidget()->cursor().shape()
                                                : Qt::ArrowCursor);
  if (pointerText() != before) update();
  if (!dragging_) return event->setAccepted(!over_);
  const QRect whole = pictureRect(rect());
  setDivider((event->position().x() - whole.left()) / std::max(1, whole.width()));
}

void SplitPicture::mouseReleaseEvent(QMouseEvent* event) {
  if (!std::exchange(dragging_, false)) event->setAccepted(!over_);
}

void SplitPicture::leaveEvent(QEvent* event) {
  QWidget::leaveEvent(event);
  const QString before = pointerText();
  pointer_.reset();
  if (!before.isEmpty()) update();
}

void SplitPicture::keyPressEvent(QKeyEvent* event) {
  const double by = event->modifiers() & Qt::ShiftModifier ? kLeap : kNudge;
  switch (event->key()) {
    case Qt::Key_Left:
      return setDivider(divider_ - by);
    case Qt::Key_Right:
      return setDivider(divider_ + by);
    case Qt::Key_Home:
      return setDivider(0);
    case Qt::Key_End:
      return setDivider(1);
    default:
      return QWidget::keyPressEvent(event);
  }
}

void SplitPicture::focusInEvent(QFocusEvent* event) {
  QWidget::focusInEvent(event);
  update();
}

void SplitPicture::focusOutEvent(QFocusEvent* event) {
  QWidget::focusOutEvent(event);
  update();
}

}  // namespace trimtab::workbench
