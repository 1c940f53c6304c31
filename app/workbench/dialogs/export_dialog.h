// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QDialog>

#include "trimtab/preset/preset.h"

class QComboBox;
class QLineEdit;
class QPlainTextEdit;

namespace trimtab::workbench {

/// Asks for what an export contains beside the parameters: format, author and comment. The author is
/// remembered in the user's settings.
class ExportDialog : public QDialog {
  Q_OBJECT

 public:
  explicit ExportDialog(QWidget* parent = nullptr);
  ExportFormat format() const;
  QString author() const;
  QString comment() const;
  QString suffix() const;
  QString fileFilter() const;

 private:
  QComboBox* format_;
  QLineEdit* author_;
  QPlainTextEdit* comment_;
};

/// Returns the format by the file's ending: JSON unless it is .xml or .ini.
ExportFormat exportFormatOf(const QString& file);

}  // namespace trimtab::workbench
