// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QLabel>
#include <QPointer>

namespace trimtab::views {

/// A place for a sentence about what was just done, such as a refusal. It keeps its two lines while it is
/// empty, so that a sentence never moves a control under the pointer.
class NoteLine : public QLabel {
  Q_OBJECT
 public:
  explicit NoteLine(QWidget* parent = nullptr);
  void say(const QString& text, const QColor& colour);

 protected:
  void changeEvent(QEvent* event) override;

 private:
  void keepPlace();
};

/// A sentence about one control, painted over what is beside that control instead of moving it. It stays
/// while the sentence holds, but gives way as soon as the pointer or the focus comes to what it covers; the
/// pointer or the focus on the control brings it back.
class NoteBubble : public QLabel {
  Q_OBJECT
 public:
  /// `control` is in a layout of its parent, in which the bubble shows.
  explicit NoteBubble(QWidget& control);
  void say(const QString& text, const QColor& colour);

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;
  void enterEvent(QEnterEvent* event) override;

 private:
  void place();
  void onFocus(const QWidget* now);

  QPointer<QWidget> control_;
};

}  // namespace trimtab::views
