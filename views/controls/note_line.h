// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QLabel>
#include <QPointer>

#include "views/model/theme.h"

namespace trimtab::views {

/// A place for a sentence about what was just done, such as a refusal. It keeps its two lines while it is
/// empty, so that a sentence never moves a control under the pointer.
class NoteLine : public QLabel {
  Q_OBJECT
 public:
  explicit NoteLine(QWidget* parent = nullptr);
  void say(const QString& text, Ink ink);

 protected:
  void changeEvent(QEvent* event) override;

 private:
  void keepPlace();
};

/// Shows a sentence about one control, such as a refusal, in a bubble over the neighbouring widgets, so that
/// nothing moves. The bubble is hidden while the pointer or the focus is on a widget that it covers, and is
/// shown again when either returns to the control. An empty sentence removes it.
class NoteBubble : public QLabel {
  Q_OBJECT
 public:
  /// `control` is in a layout of its parent, in which the bubble shows.
  explicit NoteBubble(QWidget& control);
  void say(const QString& text, Ink ink);

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;
  void enterEvent(QEnterEvent* event) override;

 private:
  void place();
  void onFocus(const QWidget* now);

  QPointer<QWidget> control_;
};

}  // namespace trimtab::views
