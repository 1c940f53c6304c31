// SPDX-License-Identifier: GPL-3.0-or-later
#include "throttle.h"

#include <QEvent>

namespace trimtab::views {
namespace {

constexpr int kRestPeriods = 3;

const QElapsedTimer& beat() {
  static const QElapsedTimer timer = [] {
    QElapsedTimer started;
    started.start();
    return started;
  }();
  return timer;
}

}  // namespace

Throttle::Throttle(QWidget* widget, std::function<void()> refresh, int periodMs)
    : QObject(widget), widget_(widget), refresh_(std::move(refresh)), periodMs_(periodMs) {
  timer_.setSingleShot(true);
  // A timer that fires shortly before a beat would be started for the same beat again.
  timer_.setTimerType(Qt::PreciseTimer);
  connect(&timer_, &QTimer::timeout, this, &Throttle::fire);
  widget->installEventFilter(this);
}

void Throttle::request() {
  wanted_ = true;
  if (timer_.isActive() || !widget_->isVisible()) return;
  // Only the window itself hears that it is no longer minimised.
  if (widget_->window()->isMinimized()) return widget_->window()->installEventFilter(this);
  // The first request after a rest is served at once, any other on the beat that all share.
  const bool rested = !sinceLast_.isValid() || sinceLast_.elapsed() >= kRestPeriods * periodMs_;
  timer_.start(rested ? 0 : periodMs_ - static_cast<int>(beat().elapsed() % periodMs_));
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
