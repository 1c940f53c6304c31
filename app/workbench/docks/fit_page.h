// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QTemporaryDir>
#include <QTimer>
#include <QWidget>
#include <optional>

#include "app/workbench/jobs/child_run.h"
#include "leverage_page.h"
#include "trimtab/preset/parameters.h"
#include "trimtab/rig/ig_fit.h"

class QPlainTextEdit;

namespace trimtab::views {
class Draft;
}

namespace trimtab::workbench {

/// Fits the preset to the image generator of the draft: runs it with the variables TRIMTAB_PROFILE and
/// TRIMTAB_FIT, by which the library in it begins a fit, and reads the file that it writes. An image
/// generator that ends early, or is cancelled, leaves what it has, which counts if there are enough views.
class FitPage : public QWidget {
  Q_OBJECT

 public:
  /// `source` writes preset and flight for the image generator; it reports itself what fails.
  FitPage(views::Draft& draft, LeveragePage::Source source, QWidget* parent = nullptr);

  /// Gives the focus to the command line.
  void begin();
  void run();
  void cancel();
  void open(const QString& file);
  void use();
  const ChildRun& child() const { return child_; }
  bool running() const { return child_.running(); }
  const std::optional<IgFit>& fit() const { return fit_; }

 signals:
  void finished(bool good);
  void refused(const QString& what, const trimtab::Findings& findings);
  void profileAsked();
  /// The person wants the preset that was fitted; `notes` say what is different.
  void chosen(const trimtab::TuningParameters& values, const trimtab::Findings& notes,
              const QString& undoText);

 private:
  QWidget* makeContent();
  void askOpen();
  QString fileOfRun() const;
  void showImageGenerator();
  void showProgress();
  void showRunning();
  void onEnded(const ChildRun::Ended& how);
  /// Shows a fit; returns why it cannot be used.
  Findings show(const QString& file);

  views::Draft& draft_;
  LeveragePage::Source source_;
  ChildRun child_;
  QTemporaryDir folder_;
  QTimer looks_;  ///< at the file of a run
  std::optional<IgFit> fit_;
  int runs_ = 0;

  QLabel* ig_;
  QLineEdit *command_, *flight_;
  QPushButton *profile_, *choose_, *run_, *open_, *use_;
  QProgressBar* progress_;
  QLabel* status_;
  QPlainTextEdit* output_;
  ReportView* report_;
};

}  // namespace trimtab::workbench
