// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QWidget>

#include "views/model/draft.h"
#include "views/model/live.h"
#include "views/model/throttle.h"

namespace trimtab::views {

/// Shows Eq. (2) for the last frame: for each rule its conditions' memberships, how far it fires (mu), its
/// share of the weights (lambda mu) and its output, and the total. It uses the frame's memberships and the
/// active rules, whatever the combination.
class RuleViewer : public QWidget {
  Q_OBJECT
 public:
  explicit RuleViewer(Draft& draft, QWidget* parent = nullptr);
  void showFrame(const LiveFrame& frame);
  /// Returns what is drawn, one line per rule: "Low, nose down: 1.000, 0.500, fires 0.500, counts 0.500,
  /// output 2".
  QStringList lines() const;

  QSize sizeHint() const override;
  QSize minimumSizeHint() const override;

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  struct Row;
  struct Picture;
  Picture picture() const;
  int lineHeight() const;

  Draft& draft_;
  FrameDecision decision_;
  bool any_ = false;
  Throttle throttle_;
};

}  // namespace trimtab::views
