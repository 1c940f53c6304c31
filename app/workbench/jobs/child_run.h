// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QObject>
#include <QProcess>
#include <QStringList>

#include "trimtab/units/result.h"

namespace trimtab::workbench {

/// Runs `trimtab-cli` as a program of its own for long work, so that the window responds and cancelling
/// always works.
class ChildRun : public QObject {
  Q_OBJECT

 public:
  struct Ended {
    bool cancelled = false, good = false;
    QByteArray output;  ///< its standard output
    Findings findings;  ///< why it failed; empty if it was cancelled
  };

  explicit ChildRun(QObject* parent = nullptr);
  ~ChildRun() override;

  /// Does nothing while a run is under way.
  void start(const QStringList& arguments);
  void cancel();
  bool running() const { return process_.state() != QProcess::NotRunning; }

 signals:
  void runningChanged(bool running);
  void progressed(int percent, const QString& what);
  void ended(const trimtab::workbench::ChildRun::Ended& how);

 private:
  void onErrors();
  void onFinished(int exitCode, QProcess::ExitStatus status);

  QProcess process_;
  QByteArray output_, errors_;
  bool cancelled_ = false;
};

}  // namespace trimtab::workbench
