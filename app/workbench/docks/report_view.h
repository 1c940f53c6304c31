// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QWidget>
#include <optional>

#include "app/experiment/report.h"

class QComboBox;
class QPlainTextEdit;
class QTableWidget;

namespace trimtab::views {
class ReportPlot;
}

namespace trimtab::workbench {

/// Shows what an experiment measured: its table, its plots and its notes.
class ReportView : public QWidget {
  Q_OBJECT

 public:
  /// `what` names the table for whoever cannot see it.
  explicit ReportView(const QString& what, QWidget* parent = nullptr);

  void show(const experiment::Report& report);
  const std::optional<experiment::Report>& report() const { return report_; }
  QTableWidget& table() { return *table_; }

 private:
  void showPlot(int index);

  std::optional<experiment::Report> report_;
  QTableWidget* table_;
  QComboBox* plots_;
  views::ReportPlot* plot_;
  QPlainTextEdit* notes_;
};

}  // namespace trimtab::workbench
