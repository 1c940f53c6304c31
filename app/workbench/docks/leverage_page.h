// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QTemporaryDir>
#include <QWidget>
#include <functional>
#include <optional>

#include "app/experiment/report.h"
#include "app/workbench/jobs/child_run.h"

class QLabel;
class QLineEdit;
class QProgressBar;
class QPushButton;
class QSpinBox;

namespace trimtab::workbench {

class ReportView;

/// The files that an experiment runs over.
struct ExperimentInputs {
  QString terrain, flight, preset;  ///< the flight may be empty, as may be the terrain of a fit
};

/// Measures what each lever is worth along the open flight, and shows it as a table and plots. It runs as a
/// program of its own, so that cancelling always works.
class LeveragePage : public QWidget {
  Q_OBJECT

 public:
  /// Writes what exists only in memory into the folder. Returns nothing if no terrain is open, or if writing
  /// fails, which it reports.
  using Source = std::function<std::optional<ExperimentInputs>(const QString& folder)>;

  explicit LeveragePage(Source source, QWidget* parent = nullptr);

  void run();
  void cancel();
  const ChildRun& child() const { return child_; }
  bool running() const { return child_.running(); }
  const std::optional<experiment::Report>& report() const;

 signals:
  void finished(bool good);
  void refused(const QString& what, const trimtab::Findings& findings);

 private:
  void onEnded(const ChildRun::Ended& how);
  void save();
  void setRunning(bool running);

  Source source_;
  ChildRun child_;
  QTemporaryDir folder_;

  QLineEdit* size_;
  QSpinBox* repeats_;
  QPushButton *run_, *save_;
  QProgressBar* progress_;
  QLabel* status_;
  ReportView* report_;
};

}  // namespace trimtab::workbench
