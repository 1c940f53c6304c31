// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QWidget>

#include "trimtab/units/result.h"

class QTreeWidget;

namespace trimtab::workbench {

/// Lists what went wrong or is worth knowing, the newest first: the time, what was tried, and every finding
/// with its file and place, what was expected and what was found. Rows can be copied.
class MessagePanel : public QWidget {
  Q_OBJECT

 public:
  explicit MessagePanel(QWidget* parent = nullptr);

  /// Adds one line without details.
  void note(const QString& headline);
  /// Adds a headline with its findings below it.
  void add(const QString& headline, const Findings& findings);
  int count() const;
  QString text() const;  ///< everything, in the form in which it is copied

 signals:
  void errorAdded();

 private:
  void copySelected();
  QTreeWidget* tree_;
};

}  // namespace trimtab::workbench
