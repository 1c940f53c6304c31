// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QDoubleSpinBox>

#include "views/model/draft.h"

namespace trimtab::views {

/// A spin box for a scalar parameter, with limits, step, decimals and unit from its row. It reads what the
/// table reads, so that "1200 m" becomes feet, and writes one undo step when the person has finished typing.
/// The wheel changes it only while it has the focus.
class NumberBox : public QDoubleSpinBox {
  Q_OBJECT
 public:
  NumberBox(Draft& draft, std::string_view key, QWidget* parent = nullptr);

  QString textFromValue(double value) const override;
  double valueFromText(const QString& text) const override;
  QValidator::State validate(QString& text, int& position) const override;
  void fixup(QString& text) const override;
  void stepBy(int steps) override;

 signals:
  void refused(const QString& why) const;

 protected:
  void wheelEvent(QWheelEvent* event) override;
  void keyReleaseEvent(QKeyEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void focusOutEvent(QFocusEvent* event) override;

 private:
  void read();
  void write();

  Draft& draft_;
  const ParameterRow* row_;
  MergeToken stepToken_ = 0;  ///< joins the steps while an arrow is held down or the wheel is turned
};

}  // namespace trimtab::views
