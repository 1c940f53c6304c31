// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QElapsedTimer>
#include <QObject>
#include <QTimer>
#include <QWidget>
#include <functional>

namespace trimtab::views {

/// Turns any number of requests into at most one call per `periodMs`, and none while `widget` cannot be seen;
/// one call follows when it is shown again. It costs nothing without requests.
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
