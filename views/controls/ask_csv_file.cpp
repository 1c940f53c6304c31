// SPDX-License-Identifier: GPL-3.0-or-later
#include "ask_csv_file.h"

#include <QFileDialog>

namespace trimtab::views {

QString askCsvFile(QWidget* parent, const QString& title, const QString& proposal) {
  QFileDialog dialog(parent, title, {}, QFileDialog::tr("CSV (*.csv)"));
  dialog.setAcceptMode(QFileDialog::AcceptSave);
  dialog.setDefaultSuffix(QStringLiteral("csv"));
  dialog.selectFile(proposal);
  return dialog.exec() == QDialog::Accepted ? dialog.selectedFiles().constFirst() : QString();
}

}  // namespace trimtab::views
