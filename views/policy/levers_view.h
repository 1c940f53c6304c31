// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QWidget>
#include <array>

#include "policy_live.h"

namespace trimtab::views {

/// The levers as bars over their hard range, with the usual range, the neutral value, the target and the
/// value now, and why it is there: the rules with their shares.
class LeversView : public QWidget {
  Q_OBJECT
 public:
  explicit LeversView(QWidget* parent = nullptr);
  void showLive(const PolicyLive& live);
  /// Returns what is drawn, a line for each lever: "LOD scale 2: rule 3 62 %, rule 7 38 %".
  QStringList lines() const;

  QSize sizeHint() const override;
  QSize minimumSizeHint() const override;

 protected:
  void paintEvent(QPaintEvent* event) override;
  bool event(QEvent* event) override;

 private:
  struct Bar {
    bool moved = false;
    double value = 0, target = 0;  ///< rounded to what a bar can show; NaN: none
    QString text, why;
    QString own;  ///< how the image generator knows the lever
    friend bool operator==(const Bar& a, const Bar& b) {
      return a.moved == b.moved && a.text == b.text && a.why == b.why && a.own == b.own &&
             a.value == b.value && (a.target == b.target || (a.target != a.target && b.target != b.target));
    }
  };
  Bar barOf(const PolicyLive& live, const LeverRow& row) const;
  void paintLever(QPainter& painter, const LeverRow& row, const Bar& bar, int top) const;
  int rowHeight() const;

  std::array<Bar, kLevers> bars_;
};

/// Returns why a lever has its target: the rules with their shares, the largest first.
QString whyText(const PolicyLive& live, Lever lever);

}  // namespace trimtab::views
