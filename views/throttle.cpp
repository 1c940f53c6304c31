// SPDX-License-Identifier: GPL-3.0-or-later
#include "trimtab/views/throttle.h"

#include <QEvent>
#include <algorithm>

namespace trimtab::views {

Throttle::Throttle(QWidget* widget, std::function<void()> refresh, int periodMs)
    : QObject(widget), widget_(widget), refresh_(std::move(refresh)), periodMs_(periodMs) {
  timer_.setSingleShot(true);
  connect(&timer_, &QTimer::timeout, this, &Throttle::fire);
  widget->installEventFilter(this);
}

void Throttle::request() {
  wanted_ = true;
  if (timer_.isActive() || !widget_->isVisible() || widget_->window()->isMinimized()) return;
  const qint64 wait = sinceLast_.isValid() ? periodMs_ - sinceLast_.elapsed() : 0;
  timer_.start(static_cast<int>(std::clamp<qint64>(wait, 0, periodMs_)));
}

bool Throttle::eventFilter(QObject* watched, QEvent* event) {
  if (wanted_ && (event->type() == QEvent::Show || event->type() == QEvent::WindowStateChange)) request();
  return QObject::eventFilter(watched, event);
}

void Throttle::fire() {
  if (!wanted_ || !widget_->isVisible()) return;
  wanted_ = false;
  ++refreshes_;
  sinceLast_.start();
  refresh_();
}

}  // namespace trimtab::views
