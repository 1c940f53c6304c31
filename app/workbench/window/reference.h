// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QDialog>

class QLineEdit;
class QTextBrowser;

namespace trimtab::workbench {

/// The reference of all parameters, with a search, and what F1 says about a control. It does not stop the
/// work.
class Reference : public QDialog {
  Q_OBJECT

 public:
  explicit Reference(QWidget* parent);
  /// Shows the parameters that hold every word in name, key, help or source; without a word the whole
  /// reference.
  void look(const QString& words);
  /// Shows what a control sets or does: the entry of its parameter, or its name and tool tip. Returns false
  /// if nothing is known about it. F1 in a modal dialog shows the same beside the control, because no other
  /// window can be reached then.
  bool explain(const QWidget* control);
  QLineEdit& search() { return *search_; }
  QTextBrowser& text() { return *text_; }

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  void find(const QString& words);
  void begin();

  QLineEdit* search_;
  QTextBrowser* text_;
  bool explaining_ = false;
};

}  // namespace trimtab::workbench
