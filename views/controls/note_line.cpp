// SPDX-License-Identifier: GPL-3.0-or-later
#include "note_line.h"

#include <QApplication>
#include <QEvent>

namespace trimtab::views {
namespace {

constexpr int kLines = 2, kBubblePaddingPx = 4;

}  // namespace

NoteLine::NoteLine(QWidget* parent) : QLabel(parent) {
  setWordWrap(true);
  setAlignment(Qt::AlignLeft | Qt::AlignTop);
  setTextInteractionFlags(Qt::TextSelectableByMouse);
  keepPlace();
}

void NoteLine::say(const QString& text, Ink ink) {
  setText(text);
  setToolTip(text);
  setInk(*this, ink);
}

void NoteLine::changeEvent(QEvent* event) {
  QLabel::changeEvent(event);
  if (event->type() == QEvent::FontChange) keepPlace();
}

void NoteLine::keepPlace() {
  setFixedHeight(kLines * fontMetrics().lineSpacing() + 2);
}

NoteBubble::NoteBubble(QWidget& control) : QLabel(control.parentWidget()), control_(&control) {
  setWordWrap(true);
  setAutoFillBackground(true);
  setFrameShape(QFrame::Box);
  setMargin(kBubblePaddingPx);
  setTextInteractionFlags(Qt::TextSelectableByMouse);
  setFocusPolicy(Qt::NoFocus);
  hide();
  control.installEventFilter(this);
  connect(qApp, &QApplication::focusChanged, this, [this](QWidget*, QWidget* now) { onFocus(now); });
}

void NoteBubble::say(const QString& text, Ink ink) {
  setText(text);
  setInk(*this, ink);
  place();
}

bool NoteBubble::eventFilter(QObject* watched, QEvent* event) {
  switch (event->type()) {
    case QEvent::Enter:
    case QEvent::Move:
    case QEvent::Resize:
    case QEvent::Show:
      place();
      break;
    case QEvent::Hide:
      hide();
      break;
    default:
      break;
  }
  return QLabel::eventFilter(watched, event);
}

void NoteBubble::enterEvent(QEnterEvent* event) {
  QLabel::enterEvent(event);
  hide();
}

/// Places the bubble above the control, so that the next control stays in sight, or below it if there is no
/// room above.
void NoteBubble::place() {
  if (text().isEmpty() || !control_ || !control_->isVisibleTo(parentWidget())) return hide();
  const QRect beside = control_->geometry();
  const int widthPx =
      std::max(beside.width(), std::min(parentWidget()->width() - beside.left(), sizeHint().width()));
  const int heightPx = heightForWidth(widthPx);
  const int above = beside.top() - heightPx;
  setGeometry(beside.left(), above >= 0 ? above : beside.bottom() + 1, widthPx, heightPx);
  show();
  raise();
}

void NoteBubble::onFocus(const QWidget* now) {
  if (now == nullptr || !control_ || text().isEmpty()) return;
  if (now == control_ || control_->isAncestorOf(now)) return place();
  const QRect there(now->mapTo(now->window(), QPoint()), now->size());
  if (isVisible() && now->window() == window() && there.intersects(QRect(mapTo(window(), QPoint()), size())))
    hide();
}

}  // namespace trimtab::views
