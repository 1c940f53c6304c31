// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QWidget>

#include "trimtab/units/result.h"

class QTreeWidget;

namespace trimtab::workbench {

/// What went wrong or is worth knowing, newest first: time, what was tried, and every finding with file,
/// place, expected and found. Rows can be copied.
class MessagePanel : public QWidget {
  Q_OBJECT

 public:
  explicit MessagePanel(QWidget* parent = nullptr);

  /// One line without details.
  void note(const QString& headline);
  /// A headline and its findings below it.
  void add(const QString& headline, const Findings& findings);
  int count() const;
  QString text() const;  ///< all of it, as copied

 signals:
  void errorAdded();

 private:
  void copySelected();
  QTreeWidget* tree_;
};

}  // namespace trimtab::workbench
