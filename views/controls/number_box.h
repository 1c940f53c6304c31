// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QDoubleSpinBox>

#include "views/model/draft.h"

namespace trimtab::views {

/// A spin box of a scalar parameter: limits, step, decimals and unit from its row. Reads what the table
/// reads, so "1200 m" becomes feet; writes one undo step when the typing is done. The wheel does nothing
/// without the focus.
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
  MergeToken stepToken_ = 0;  ///< of an arrow held down, or the wheel turned on
};

}  // namespace trimtab::views
