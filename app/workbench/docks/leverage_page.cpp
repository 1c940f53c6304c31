// SPDX-License-Identifier: GPL-3.0-or-later
#include "leverage_page.h"

#include <QDir>
#include <QFileDialog>
#include <QHBoxLayout>
#include <QLabel>
#include <QLineEdit>
#include <QProgressBar>
#include <QPushButton>
#include <QRegularExpression>
#include <QRegularExpressionValidator>
#include <QSpinBox>
#include <QVBoxLayout>

#include "app/experiment/leverage.h"
#include "pause_button.h"
#include "report_view.h"

namespace trimtab::workbench {
LeveragePage::LeveragePage(Source source, QWidget* parent)
    : QWidget(parent),
      source_(std::move(source)),
      size_(new QLineEdit(QStringLiteral("1280x720"), this)),
      repeats_(new QSpinBox(this)),
      run_(new QPushButton(tr("&Run"), this)),
      save_(new QPushButton(tr("&Save…"), this)),
      progress_(new QProgressBar(this)),
      status_(new QLabel(this)),
      report_(new ReportView(tr("What each lever is worth"), this)) {
  size_->setValidator(new QRegularExpressionValidator(
      QRegularExpression(QStringLiteral("[1-9][0-9]{1,4}x[1-9][0-9]{1,4}")), size_));
  size_->setMaximumWidth(90);
  size_->setToolTip(tr("Render size in pixels. Smaller is faster; compare ratios at one size only"));
  repeats_->setRange(1, 100);
  repeats_->setValue(3);
  repeats_->setSuffix(tr(" frames"));
  repeats_->setToolTip(tr("Frames per view; their median counts"));
  repeats_->setAccessibleName(tr("Frames per view"));
  status_->setWordWrap(true);
  save_->setEnabled(false);

  auto* top = new QHBoxLayout;
  auto* sizeLabel = new QLabel(tr("Si&ze"), this);
  sizeLabel->setBuddy(size_);
  top->addWidget(sizeLabel);
  top->addWidget(size_);
  top->addWidget(repeats_);
  top->addStretch(1);
  top->addWidget(run_);
  top->addWidget(makePauseButton(child_, this));
  top->addWidget(save_);

  auto* column = new QVBoxLayout(this);
  column->addLayout(top);
  column->addWidget(progress_);
  column->addWidget(status_);
  column->addWidget(report_, 1);

  connect(run_, &QPushButton::clicked, this, [this] { running() ? cancel() : run(); });
  connect(save_, &QPushButton::clicked, this, &LeveragePage::save);
  connect(&child_, &ChildRun::progressed, this, [this](int percent, const QString& what) {
    progress_->setValue(percent);
    status_->setText(what);
  });
  connect(&child_, &ChildRun::ended, this, &LeveragePage::onEnded);
  setRunning(false);
}

void LeveragePage::setRunning(bool running) {
  run_->setText(running ? tr("&Cancel") : tr("&Run"));
  progress_->setVisible(running);
  progress_->setValue(0);
  size_->setEnabled(!running);
  repeats_->setEnabled(!running);
  if (!running && !report())
    status_->setText(
        tr("Measures along the open flight with the current preset, on this machine. Other programs disturb "
           "the times."));
}

const std::optional<experiment::Report>& LeveragePage::report() const {
  return report_->report();
}

void LeveragePage::run() {
  if (running()) return;
  const std::optional<ExperimentInputs> inputs = source_(folder_.path());
  // What a person has to do first stands here, where the person looks: the Messages dock would cover it.
  if (!inputs)
    return status_->setText(tr(
        "Not started: leverage needs an open terrain (Ctrl+T opens one), and the dock Messages says if its "
        "input could not be written."));
  if (inputs->flight.isEmpty())
    return status_->setText(tr("Not started: leverage is measured along a flight. Ctrl+L opens one."));
  const QStringList arguments{QStringLiteral("leverage"),
                              QStringLiteral("--terrain"),
                              inputs->terrain,
                              QStringLiteral("--preset"),
                              inputs->preset,
                              QStringLiteral("--size"),
                              size_->text(),
                              QStringLiteral("--repeats"),
                              QString::number(repeats_->value()),
                              QStringLiteral("--json"),
                              QStringLiteral("--flight"),
                              inputs->flight};
  setRunning(true);
  status_->setText(tr("Starting…"));
  child_.start(arguments);
}

void LeveragePage::cancel() {
  if (!running()) return;
  status_->setText(tr("Cancelling…"));
  child_.cancel();
}

void LeveragePage::onEnded(const ChildRun::Ended& how) {
  setRunning(false);
  if (how.cancelled) {
    status_->setText(tr("Cancelled; the earlier results are kept."));
    emit finished(false);
    return;
  }
  Findings findings = how.findings;
  if (how.good) {
    const Result<experiment::Leverage> read = experiment::parseLeverage(
        std::string_view(how.output.constData(), std::size_t(how.output.size())), "trimtab-cli");
    findings = read.findings();
    if (read) {
      findings.clear();  // notes
      report_->show(experiment::toReport(*read));
      save_->setEnabled(true);
    }
  }
  if (!findings.empty()) {
    status_->setText(tr("Failed; the earlier results are kept."));
    emit refused(tr("Leverage was not measured"), findings);
    emit finished(false);
    return;
  }
  status_->setText(tr("Done"));
  emit finished(true);
}

void LeveragePage::save() {
  const QString folder = QFileDialog::getExistingDirectory(this, tr("Folder for tables and plots"));
  if (folder.isEmpty() || !report()) return;
  const auto written = experiment::writeReport(folder.toStdString(), *report());
  if (!written.findings().empty())
    emit refused(written ? tr("The results are saved") : tr("The results cannot be saved"),
                 written.findings());
  if (written) status_->setText(tr("Saved to %1").arg(QDir::toNativeSeparators(folder)));
}

}  // namespace trimtab::workbench
