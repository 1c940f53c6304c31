// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QApplication>
#include <QEventLoop>
#include <QTimer>
#include <chrono>
#include <functional>
#include <limits>
#include <random>
#include <thread>
#include <utility>
#include <vector>

#include "app/experiment/stage.h"
#include "app/workbench/window/main_window.h"
#include "row.h"

namespace trimtab::bench {

/// Sees the window as a person does: it knows when a widget was painted with the effect of an input, and when
/// that painting has reached the display.
class Eye : public QObject {
 public:
  static constexpr int kPatienceMs = 10'000;
  using Condition = std::function<bool()>;

  explicit Eye(workbench::MainWindow& window) {
    connect(&window.viewport(), &workbench::Viewport::painted, this, [this] {
      const double now = monotonicSeconds();
      if (lastImage_ > 0) gapsMs_.push_back(1e3 * (now - lastImage_));
      lastImage_ = now;
    });
    qApp->installEventFilter(this);
  }

  /// Calls `flushed` whenever the widget, or one inside it, was painted while the condition held, and the
  /// window has reached the display since.
  void watch(const QWidget& widget, Condition condition, std::function<void()> flushed) {
    widget_ = &widget;
    condition_ = std::move(condition);
    flushed_ = std::move(flushed);
    painted_ = false;
  }
  void close() { widget_ = nullptr, flushed_ = nullptr; }

  /// Returns the milliseconds from an input until the widget shows its effect. Another thread posts the input
  /// at a moment of its own, so that it waits behind whatever the main thread does just then. Returns the
  /// limit of patience if no effect is seen.
  double reactionMs(const QWidget& widget, const std::function<void()>& input, Condition inEffect) {
    QEventLoop loop;
    double posted = 0, ms = kPatienceMs;
    bool sent = false;
    watch(
        widget, [&sent, inEffect = std::move(inEffect)] { return sent && inEffect(); },
        [&] {
          if (ms < kPatienceMs) return;
          ms = 1e3 * (monotonicSeconds() - posted);
          loop.quit();
        });
    const auto pause = std::chrono::milliseconds(std::uniform_int_distribution(50, 250)(random_));
    std::thread person([&] {
      std::this_thread::sleep_for(pause);
      posted = monotonicSeconds();
      QMetaObject::invokeMethod(
          &loop,
          [&] {
            sent = true;
            input();
          },
          Qt::QueuedConnection);
    });
    QTimer::singleShot(kPatienceMs, &loop, &QEventLoop::quit);
    loop.exec();
    person.join();
    close();
    return ms;
  }

  void forgetImages() { gapsMs_.clear(), lastImage_ = 0; }
  double imageGapMs() const {
    return gapsMs_.empty() ? std::numeric_limits<double>::quiet_NaN() : experiment::quantileOf(gapsMs_, 0.5);
  }

 protected:
  bool eventFilter(QObject* object, QEvent* event) override {
    if (event->type() != QEvent::Paint || widget_ == nullptr || !object->isWidgetType()) return false;
    const auto* painting = static_cast<const QWidget*>(object);
    if (painting != widget_ && !widget_->isAncestorOf(painting)) return false;
    // What is painted is sent before the next event is handled.
    if (!painted_ && condition_()) {
      painted_ = true;
      QMetaObject::invokeMethod(this, &Eye::onFlushed, Qt::QueuedConnection);
    }
    return false;
  }

 private:
  void onFlushed() {
    if (std::exchange(painted_, false) && flushed_) flushed_();
  }

  std::mt19937 random_{7};
  const QWidget* widget_ = nullptr;
  Condition condition_;
  std::function<void()> flushed_;
  bool painted_ = false;
  std::vector<double> gapsMs_;
  double lastImage_ = 0;
};

}  // namespace trimtab::bench
