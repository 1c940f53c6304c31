// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QDialog>
#include <optional>

#include "export_target.h"
#include "trimtab/preset/preset.h"

class QComboBox;
class QLineEdit;
class QPlainTextEdit;

namespace trimtab::workbench {

/// Asks for what an export contains beside the parameters: format, author and comment; and after the first
/// export also for the file, so that another dialog is needed only for a new one. The author is remembered in
/// the user's settings.
class ExportDialog : public QDialog {
  Q_OBJECT

 public:
  /// `before` fills the fields as they were at the last export.
  explicit ExportDialog(const std::optional<ExportTarget>& before, QWidget* parent = nullptr);
  ExportFormat format() const;
  QString author() const;
  QString comment() const;
  /// Returns the file of the last export, or what the person made of it; empty if it is still to be asked
  /// for.
  QString file() const;
  QString suffix() const;
  QString fileFilter() const;

 private:
  QLayout* makeFile(const QString& file);
  void askFile();

  QComboBox* format_;
  QLineEdit* file_;
  QLineEdit* author_;
  QPlainTextEdit* comment_;
};

/// Returns the format by the file's ending: JSON unless it is .xml or .ini.
ExportFormat exportFormatOf(const QString& file);

}  // namespace trimtab::workbench
