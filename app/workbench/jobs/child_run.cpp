// SPDX-License-Identifier: GPL-3.0-or-later
#include "child_run.h"

#include <signal.h>

#include <QCoreApplication>
#include <QRegularExpression>
#include <QTimer>

namespace trimtab::workbench {
namespace {

/// Given up when it does not end this soon after it was asked to.
constexpr int kStopMs = 3000;

}  // namespace

ChildRun::ChildRun(QObject* parent) : QObject(parent) {
  connect(&process_, &QProcess::readyReadStandardError, this, &ChildRun::onErrors);
  connect(&process_, &QProcess::readyReadStandardOutput, this,
          [this] { output_ += process_.readAllStandardOutput(); });
  connect(&process_, &QProcess::stateChanged, this, [this](QProcess::ProcessState state) {
    if (state != QProcess::Running) emit runningChanged(running());
  });
  connect(&process_, &QProcess::finished, this, &ChildRun::onFinished);
  connect(&process_, &QProcess::errorOccurred, this, [this](QProcess::ProcessError error) {
    if (error != QProcess::FailedToStart) return;
    emit ended({false,
                false,
                {},
                {{Severity::error,
                  process_.program().toStdString(),
                  {},
                  "the program trimtab-cli beside this one",
                  process_.errorString().toStdString()}}});
  });
}

ChildRun::~ChildRun() {
  process_.disconnect(this);
  if (!running()) return;
  process_.kill();
  process_.waitForFinished(kStopMs);
}

void ChildRun::start(const QStringList& arguments) {
  if (running()) return;
  output_.clear();
  errors_.clear();
  cancelled_ = false;
  process_.start(QCoreApplication::applicationDirPath() + QStringLiteral("/trimtab-cli"), arguments);
}

void ChildRun::cancel() {
  if (!running()) return;
  cancelled_ = true;
  // 0 would be this program and all it started.
  if (const auto id = static_cast<pid_t>(process_.processId()); id > 0) ::kill(id, SIGINT);
  QTimer::singleShot(kStopMs, &process_, [this] {
    if (cancelled_ && running()) process_.kill();
  });
}

/// Progress lines are " 12 % what"; anything else is a finding.
void ChildRun::onErrors() {
  static const QRegularExpression kProgress(QStringLiteral("^\\s*(\\d+) % (.*)$"));
  errors_ += process_.readAllStandardError();
  for (qsizetype end = errors_.indexOf('\n'), from = 0; end >= 0; end = errors_.indexOf('\n', from)) {
    const QRegularExpressionMatch line =
        kProgress.match(QString::fromUtf8(errors_.constData() + from, end - from));
    if (line.hasMatch()) {
      emit progressed(line.captured(1).toInt(), line.captured(2));
      errors_.remove(from, end - from + 1);
    } else {
      from = end + 1;
    }
  }
}

void ChildRun::onFinished(int exitCode, QProcess::ExitStatus status) {
  onErrors();
  output_ += process_.readAllStandardOutput();
  Ended how{cancelled_, !cancelled_ && status == QProcess::NormalExit && exitCode == 0, output_, {}};
  if (!how.good && !how.cancelled) {
    const QByteArray said = errors_.trimmed();
    how.findings.push_back({Severity::error,
                            "trimtab-cli " + process_.arguments().value(0).toStdString(),
                            {},
                            "to end well",
                            said.isEmpty() ? "exit code " + std::to_string(exitCode) : said.toStdString()});
  }
  emit ended(how);
}

}  // namespace trimtab::workbench
