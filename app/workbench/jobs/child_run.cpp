// SPDX-License-Identifier: GPL-3.0-or-later
#include "child_run.h"

#include <signal.h>
#include <unistd.h>

#include <QCoreApplication>
#include <QRegularExpression>

namespace trimtab::workbench {
namespace {

/// Given up when it does not end this soon after it was asked to.
constexpr int kStopMs = 3000;

}  // namespace

ChildRun::ChildRun(QObject* parent) : QObject(parent) {
  connect(&process_, &QProcess::readyReadStandardError, this, &ChildRun::onErrors);
  connect(&process_, &QProcess::readyReadStandardOutput, this, &ChildRun::onOutput);
  connect(&process_, &QProcess::stateChanged, this, [this](QProcess::ProcessState state) {
    if (state != QProcess::Running) emit runningChanged(running());
  });
  connect(&process_, &QProcess::finished, this, &ChildRun::onFinished);
  patience_.setSingleShot(true);
  connect(&patience_, &QTimer::timeout, this, [this] { signal(SIGKILL); });
  connect(&process_, &QProcess::errorOccurred, this, [this](QProcess::ProcessError error) {
    if (error != QProcess::FailedToStart) return;
    emit ended({false,
                false,
                {},
                {{Severity::error,
                  process_.program().toStdString(),
                  {},
                  other_ ? "a program of this name" : "the program trimtab-cli beside this one",
                  process_.errorString().toStdString()}}});
  });
}

ChildRun::~ChildRun() {
  process_.disconnect(this);
  if (!running()) return;
  signal(SIGKILL);
  process_.waitForFinished(kStopMs);
}

void ChildRun::start(const QStringList& arguments) {
  if (running()) return;
  other_ = false;
  begin(QCoreApplication::applicationDirPath() + QStringLiteral("/trimtab-cli"), arguments,
        QProcessEnvironment(QProcessEnvironment::InheritFromParent));
}

void ChildRun::start(const QString& program, const QStringList& arguments,
                     const std::vector<std::pair<QString, QString>>& variables) {
  if (running()) return;
  other_ = true;
  QProcessEnvironment environment = QProcessEnvironment::systemEnvironment();
  for (const auto& [variable, value] : variables) environment.insert(variable, value);
  begin(program, arguments, environment);
}

void ChildRun::begin(const QString& program, const QStringList& arguments,
                     const QProcessEnvironment& environment) {
  output_.clear();
  errors_.clear();
  cancelled_ = false;
  process_.setProcessEnvironment(environment);
  // A group of its own, which signal() reaches as a whole.
  process_.setChildProcessModifier(other_ ? std::function<void()>([] { ::setpgid(0, 0); }) : nullptr);
  process_.start(program, arguments);
}

/// Sends a signal to the program, and to all that another program started: it may be a script.
void ChildRun::signal(int number) {
  // 0 would be this program and all it started.
  if (const auto id = static_cast<pid_t>(process_.processId()); id > 0) ::kill(other_ ? -id : id, number);
}

void ChildRun::cancel() {
  if (!running()) return;
  cancelled_ = true;
  signal(other_ ? SIGTERM : SIGINT);
  patience_.start(kStopMs);
}

void ChildRun::onOutput() {
  const QByteArray text = process_.readAllStandardOutput();
  output_ += text;
  if (!text.isEmpty()) emit said(QString::fromLocal8Bit(text));
}

QString ChildRun::name() const {
  return other_ ? process_.program() : QStringLiteral("trimtab-cli ") + process_.arguments().value(0);
}

/// Progress lines are " 12 % what"; anything else is a finding.
void ChildRun::onErrors() {
  static const QRegularExpression kProgress(QStringLiteral("^\\s*(\\d+) % (.*)$"));
  const QByteArray text = process_.readAllStandardError();
  errors_ += text;
  if (!text.isEmpty()) emit said(QString::fromLocal8Bit(text));
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
  patience_.stop();
  onErrors();
  onOutput();
  Ended how{cancelled_, !cancelled_ && status == QProcess::NormalExit && exitCode == 0, output_, {}};
  if (!how.good && !how.cancelled) {
    // The findings of trimtab-cli say it all; of another program, nobody knows which lines matter.
    const std::string code = status == QProcess::CrashExit ? "the end by signal " + std::to_string(exitCode)
                                                           : "exit code " + std::to_string(exitCode);
    const QByteArray text = (other_ && errors_.trimmed().isEmpty() ? output_ : errors_).trimmed();
    const std::string last = (other_ ? text.mid(text.lastIndexOf('\n') + 1) : text).toStdString();
    how.findings.push_back({Severity::error,
                            name().toStdString(),
                            {},
                            "to end well",
                            last.empty() ? code
                            : other_     ? code + ": " + last
                                         : last});
  }
  emit ended(how);
}

}  // namespace trimtab::workbench
