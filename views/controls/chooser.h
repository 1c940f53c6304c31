// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QComboBox>
#include <QString>
#include <QWheelEvent>

namespace trimtab::views {

/// A list of choices in a place that scrolls. The wheel changes it only while it has the focus.
class Chooser : public QComboBox {
 public:
  explicit Chooser(const QString& name, QWidget* parent = nullptr) : QComboBox(parent) {
    setAccessibleName(name);
    setFocusPolicy(Qt::StrongFocus);
  }

 protected:
  void wheelEvent(QWheelEvent* event) override {
    if (hasFocus())
      QComboBox::wheelEvent(event);
    else
      event->ignore();
  }
};

}  // namespace trimtab::views
