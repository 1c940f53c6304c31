// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QDialog>

#include "trimtab/preset/preset.h"

class QComboBox;
class QLineEdit;
class QPlainTextEdit;

namespace trimtab::workbench {

/// Asks for what goes into an export beside the parameters: format, author, comment. The author is
/// remembered.
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

/// By the file's ending; JSON where it is neither .xml nor .ini.
ExportFormat exportFormatOf(const QString& file);

}  // namespace trimtab::workbench
