// SPDX-License-Identifier: GPL-3.0-or-later
#include "split_picture.h"

#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>
#include <algorithm>
#include <cmath>

#include "views/model/theme.h"

namespace trimtab::workbench {
namespace {

constexpr double kNudge = 0.01, kLeap = 0.1;
constexpr int kGapPx = 4, kHandlePx = 9;

}  // namespace

SplitPicture::SplitPicture(QWidget* parent) : QWidget(parent) {
  setFocusPolicy(Qt::StrongFocus);
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Expanding);
  setAccessibleName(tr("Two presets on one frame"));
  describe();
}

void SplitPicture::describe() {
  setAccessibleDescription(
      tr("%1 to the left of %2 %, %3 to the right. Left and right move the divider, with "
         "Shift ten times as far.")
          .arg(names_[0])
          .arg(std::lround(divider_ * 100))
          .arg(names_[1]));
  setCursor(beside_ || pictures_[0].isNull() ? Qt::ArrowCursor : Qt::SplitHCursor);
}

void SplitPicture::show(const QImage& left, const QImage& right) {
  pictures_ = {left, right};
  describe();
  update();
}

void SplitPicture::setNames(const QString& left, const QString& right) {
  names_ = {left, right};
  describe();
  update();
}

void SplitPicture::setBeside(bool beside) {
  beside_ = beside;
  describe();
  update();
}

void SplitPicture::setDivider(double share) {
  divider_ = std::clamp(share, 0.0, 1.0);
  describe();
  update();
}

QRect SplitPicture::pictureRect() const {
  QRect rect({}, pictures_[0].size().scaled(size(), Qt::KeepAspectRatio));
  rect.moveCenter(this->rect().center());
  return rect;
}

void SplitPicture::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.fillRect(rect(), palette().color(QPalette::Base));
  if (pictures_[0].isNull() || pictures_[1].isNull()) {
    painter.setPen(palette().color(QPalette::Text));
    painter.drawText(rect(), Qt::AlignCenter | Qt::TextWordWrap,
                     tr("The images appear here as soon as they are drawn."));
    return views::paintFocusFrame(*this);
  }
  painter.setRenderHint(QPainter::SmoothPixmapTransform);
  std::array<QRect, 2> to, clip;
  if (beside_) {
    for (int side = 0; side < 2; ++side) {
      const QRect half(side * (width() + kGapPx) / 2, 0, (width() - kGapPx) / 2, height());
      QRect at({}, pictures_[std::size_t(side)].size().scaled(half.size(), Qt::KeepAspectRatio));
      at.moveCenter(half.center());
      to[std::size_t(side)] = clip[std::size_t(side)] = at;
    }
  } else {
    const QRect whole = pictureRect();
    const int at = whole.left() + int(std::lround(whole.width() * divider_));
    to = {whole, whole};
    clip[0] = QRect(whole.left(), whole.top(), at - whole.left(), whole.height());
    clip[1] = QRect(at, whole.top(), whole.right() + 1 - at, whole.height());
  }
  const QFontMetrics metrics(font());
  for (std::size_t side = 0; side < 2; ++side) {
    painter.setClipRect(clip[side]);
    painter.drawImage(to[side], pictures_[side]);
    const QSize label(metrics.horizontalAdvance(names_[side]) + 12, metrics.height() + 6);
    QRect box(QPoint(clip[side].left() + 6, clip[side].top() + 6), label);
    if (side == 1) box.moveRight(clip[side].right() - 6);
    painter.fillRect(box, QColor(0, 0, 0, 170));
    painter.setPen(Qt::white);
    painter.drawText(box, Qt::AlignCenter, names_[side]);
  }
  painter.setClipping(false);
  if (!beside_) {
    const int x = clip[1].left();
    painter.setPen(QPen(Qt::black, 4));
    painter.drawLine(x, to[0].top(), x, to[0].bottom());
    painter.setPen(QPen(Qt::white, 2));
    painter.drawLine(x, to[0].top(), x, to[0].bottom());
    painter.setRenderHint(QPainter::Antialiasing);
    painter.setBrush(Qt::white);
    painter.setPen(Qt::black);
    painter.drawEllipse(QPoint(x, to[0].center().y()), kHandlePx, kHandlePx);
  }
  views::paintFocusFrame(*this);
}

void SplitPicture::mousePressEvent(QMouseEvent* event) {
  setFocus(Qt::MouseFocusReason);
  mouseMoveEvent(event);
}

void SplitPicture::mouseMoveEvent(QMouseEvent* event) {
  if (beside_ || pictures_[0].isNull() || !(event->buttons() & Qt::LeftButton)) return;
  const QRect whole = pictureRect();
  setDivider((event->position().x() - whole.left()) / std::max(1, whole.width()));
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
