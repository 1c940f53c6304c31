// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QTemporaryDir>
#include <QWidget>

#include "leverage_page.h"

class QComboBox;
class QDoubleSpinBox;
class QLineEdit;
class QSpinBox;

namespace trimtab::workbench {

class ReportView;

/// Searches presets around the current one along the open flight, and shows what was found and what it is
/// worth. It runs as a program of its own, so that cancelling always works.
class SearchPage : public QWidget {
  Q_OBJECT

 public:
  explicit SearchPage(LeveragePage::Source source, QWidget* parent = nullptr);

  void run();
  void cancel();
  const ChildRun& child() const { return child_; }
  bool running() const { return child_.running(); }
  const std::optional<experiment::Report>& report() const;
  /// Asks for the preset of the selected row, if it was found by the search.
  void use();
  /// Copies the preset of the selected row to a file.
  void save(const QString& file);

 signals:
  void finished(bool good);
  void refused(const QString& what, const trimtab::Findings& findings);
  /// Wants a found preset to be flown. `text` is its file.
  void chosen(const QString& name, const QString& text);
  /// Wants a found preset beside the one that is flown.
  void comparisonAsked(const QString& file);

 private:
  void onEnded(const ChildRun::Ended& how);
  void setRunning(bool running);
  void rowSelected();
  void askSave();
  QString found() const;
  QString folderOf(const QStringList& arguments, const ExperimentInputs& inputs) const;

  LeveragePage::Source source_;
  ChildRun child_;
  QTemporaryDir folder_;
  QString searching_, shown_;  ///< the folders of the search that runs, and of the presets in the table

  QDoubleSpinBox* budget_;
  QLineEdit *free_, *heldOut_, *size_;
  QSpinBox *frames_, *evaluations_;
  QComboBox* error_;
  QPushButton *choose_, *run_, *use_, *compare_, *save_;
  QProgressBar* progress_;
  QLabel* status_;
  ReportView* report_;
};

}  // namespace trimtab::workbench
