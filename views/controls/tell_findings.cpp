// SPDX-License-Identifier: GPL-3.0-or-later
#include "tell_findings.h"

#include <QMessageBox>

namespace trimtab::views {

void tellFindings(QWidget* parent, const QString& failed, const QString& done, const Findings& findings) {
  if (findings.empty()) return;
  const QString text = QString::fromStdString(toString(findings));
  if (hasError(findings))
    QMessageBox::warning(parent, failed, text);
  else
    QMessageBox::information(parent, done, text);
}

Finding unknownRuleEnding(const QString& file) {
  return {Severity::error, file.toStdString(), "", "a file that ends in .fll or .fis", "another ending"};
}

}  // namespace trimtab::views
