// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QObject>
#include <QProcess>
#include <QStringList>
#include <QTimer>
#include <utility>
#include <vector>

#include "trimtab/units/result.h"

namespace trimtab::workbench {

/// Runs `trimtab-cli`, or another program, for long work, so that the window responds and cancelling always
/// works.
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
  /// Starts another program with these variables added to the environment.
  void start(const QString& program, const QStringList& arguments,
             const std::vector<std::pair<QString, QString>>& variables);
  /// Asks the program to end (`trimtab-cli` by SIGINT, another one by SIGTERM), and kills it three seconds
  /// later.
  void cancel();
  /// Asks `trimtab-cli` to stop once it times nothing, and leaves the machine to others. Nobody knows that of
  /// another program: it goes on.
  void pause();
  void goOn();
  /// Reports whether it was asked to pause, even if it still finishes an image.
  bool pauseAsked() const { return pauseAsked_; }
  /// Returns what is run, for people.
  QString name() const;
  bool running() const { return process_.state() != QProcess::NotRunning; }

 signals:
  /// It has begun or goes on, or it has paused or ended.
  void workingChanged(bool working);
  /// Pausing is among what it says.
  void progressed(int percent, const QString& what);
  void said(const QString& text);  ///< what the program has just written, to either output
  void ended(const trimtab::workbench::ChildRun::Ended& how);

 private:
  void begin(const QString& program, const QStringList& arguments, const QProcessEnvironment& environment);
  void signal(int number);
  void wake();
  void lookWhetherPaused();
  void sayProgress();
  void onOutput();
  void onErrors();
  void onFinished(int exitCode, QProcess::ExitStatus status);

  QProcess process_;
  QTimer patience_;  ///< of the cancelled run, with a program that does not end
  QTimer looks_;     ///< whether the program has paused, as it was asked to
  QByteArray output_, errors_;
  int percent_ = 0;
  QString doing_;  ///< its last progress
  bool cancelled_ = false, other_ = false, pauseAsked_ = false, paused_ = false;
};

}  // namespace trimtab::workbench
