// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QTemporaryDir>
#include <QWidget>
#include <functional>
#include <optional>

#include "app/experiment/report.h"
#include "app/workbench/jobs/child_run.h"

class QComboBox;
class QLabel;
class QLineEdit;
class QPlainTextEdit;
class QProgressBar;
class QPushButton;
class QSpinBox;
class QTableWidget;

namespace trimtab::views {
class ReportPlot;
}

namespace trimtab::workbench {

/// What an experiment is to run over, as files.
struct ExperimentInputs {
  QString terrain, flight, preset;  ///< the flight may be empty
};

/// Runs the published experiments over the terrain, flight and preset at hand, and shows their rows beside
/// ours. They run as a program of their own: the picture here goes on, and cancelling is sure.
class ExperimentsDock : public QWidget {
  Q_OBJECT

 public:
  /// Writes what is only in memory into the folder; none: no terrain is open.
  using Source = std::function<std::optional<ExperimentInputs>(const QString& folder)>;

  explicit ExperimentsDock(Source source, QWidget* parent = nullptr);

  void run();
  void cancel();
  bool running() const { return child_.running(); }
  const std::optional<experiment::Report>& report() const { return report_; }

 signals:
  void finished(bool good);
  void refused(const QString& what, const trimtab::Findings& findings);

 private:
  void onEnded(const ChildRun::Ended& how);
  void show(const experiment::Report& report);
  void showPlot(int index);
  void save();
  void setRunning(bool running);

  Source source_;
  ChildRun child_;
  QTemporaryDir folder_;
  std::optional<experiment::Report> report_;

  QComboBox *which_, *plots_;
  QLineEdit* size_;
  QSpinBox* repeats_;
  QPushButton *run_, *save_;
  QProgressBar* progress_;
  QLabel *status_, *machine_;
  QTableWidget *published_, *measured_;
  views::ReportPlot* plot_;
  QPlainTextEdit* notes_;
};

}  // namespace trimtab::workbench
