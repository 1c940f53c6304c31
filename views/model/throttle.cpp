// SPDX-License-Identifier: GPL-3.0-or-later
#include "throttle.h"

#include <QEvent>
#include <algorithm>

namespace trimtab::views {

Throttle::Throttle(QWidget* widget, std::function<void()> refresh, int periodMs)
    : QObject(widget), widget_(widget), refresh_(std::move(refresh)), periodMs_(periodMs) {
  timer_.setSingleShot(true);
  timer_.setTimerType(Qt::PreciseTimer);
  connect(&timer_, &QTimer::timeout, this, &Throttle::fire);
  widget->installEventFilter(this);
}

void Throttle::request() {
  wanted_ = true;
  if (timer_.isActive() || !widget_->isVisible()) return;
  // Only the window itself hears that it is no longer minimised.
  if (widget_->window()->isMinimized()) return widget_->window()->installEventFilter(this);
  const int sinceMs =
      sinceLast_.isValid() ? int(std::min<qint64>(sinceLast_.elapsed(), periodMs_)) : periodMs_;
  timer_.start(periodMs_ - sinceMs);
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
