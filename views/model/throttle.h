// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QElapsedTimer>
#include <QObject>
#include <QTimer>
#include <QWidget>
#include <functional>

namespace trimtab::views {

/// Turns any number of requests into at most one call each `periodMs`, and none while `widget` cannot be
/// seen: what was asked for meanwhile happens once it is shown. Idle, it costs nothing. All throttles of one
/// period fire together: a window with OpenGL in it is put together and sent anew for each widget that
/// changes on its own.
class Throttle : public QObject {
  Q_OBJECT
 public:
  Throttle(QWidget* widget, std::function<void()> refresh, int periodMs = 66);

  void request();
  std::uint64_t refreshes() const { return refreshes_; }

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  void fire();

  QWidget* widget_;
  std::function<void()> refresh_;
  int periodMs_;
  QTimer timer_;
  QElapsedTimer sinceLast_;
  bool wanted_ = false;
  std::uint64_t refreshes_ = 0;
};

}  // namespace trimtab::views
