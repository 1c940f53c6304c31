// SPDX-License-Identifier: GPL-3.0-or-later
#include "child_run.h"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <QCoreApplication>
#include <QRegularExpression>

namespace trimtab::workbench {
namespace {

/// Given up when it does not end this soon after it was asked to.
constexpr int kStopMs = 3000;
constexpr int kLookMs = 50;

}  // namespace

ChildRun::ChildRun(QObject* parent) : QObject(parent) {
  connect(&process_, &QProcess::readyReadStandardError, this, &ChildRun::onErrors);
  connect(&process_, &QProcess::readyReadStandardOutput, this, &ChildRun::onOutput);
  connect(&process_, &QProcess::stateChanged, this, [this](QProcess::ProcessState state) {
    if (state != QProcess::Running) emit workingChanged(running());
  });
  connect(&process_, &QProcess::finished, this, &ChildRun::onFinished);
  patience_.setSingleShot(true);
  connect(&patience_, &QTimer::timeout, this, [this] { signal(SIGKILL); });
  looks_.setInterval(kLookMs);
  connect(&looks_, &QTimer::timeout, this, &ChildRun::lookWhetherPaused);
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
  cancelled_ = pauseAsked_ = paused_ = false;
  percent_ = 0;
  doing_ = tr("Starting…");
  process_.setProcessEnvironment(environment);
  // A group of its own, which signal() reaches as a whole, and which the system wakes to end if it is paused
  // when this program dies. Made on both sides: either may come first.
  process_.setChildProcessModifier([] { ::setpgid(0, 0); });
  process_.start(program, arguments);
  if (const auto id = static_cast<pid_t>(process_.processId()); id > 0) ::setpgid(id, id);
}

/// Sends a signal to the program and to all that it started: it may be a script.
void ChildRun::signal(int number) {
  // 0 would be this program and all it started.
  if (const auto id = static_cast<pid_t>(process_.processId()); id > 0) ::kill(-id, number);
}

void ChildRun::cancel() {
  if (!running()) return;
  cancelled_ = true;
  signal(other_ ? SIGTERM : SIGINT);
  wake();
  patience_.start(kStopMs);
}

void ChildRun::pause() {
  if (!running() || other_ || cancelled_ || pauseAsked_) return;
  pauseAsked_ = true;
  signal(SIGTSTP);
  looks_.start();
  sayProgress();
}

void ChildRun::goOn() {
  if (!pauseAsked_) return;
  wake();
  sayProgress();
}

void ChildRun::wake() {
  looks_.stop();
  pauseAsked_ = false;
  if (std::exchange(paused_, false)) emit workingChanged(true);
  signal(SIGCONT);
}

void ChildRun::lookWhetherPaused() {
  siginfo_t stopped{};
  if (::waitid(P_PID, static_cast<id_t>(process_.processId()), &stopped, WSTOPPED | WNOHANG | WNOWAIT) != 0 ||
      stopped.si_pid == 0)
    return;
  looks_.stop();
  paused_ = true;
  sayProgress();
  emit workingChanged(false);
}

/// After cancelling there is no progress to speak of.
void ChildRun::sayProgress() {
  if (cancelled_) return;
  emit progressed(percent_, paused_       ? tr("Paused")
                            : pauseAsked_ ? tr("Pausing once the image in hand is drawn…")
                                          : doing_);
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
      percent_ = line.captured(1).toInt();
      doing_ = line.captured(2);
      sayProgress();
      errors_.remove(from, end - from + 1);
    } else {
      from = end + 1;
    }
  }
}

void ChildRun::onFinished(int exitCode, QProcess::ExitStatus status) {
  patience_.stop();
  looks_.stop();
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
