// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit_page.h"

#include <QFileDialog>
#include <QFileInfo>
#include <QFormLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QLineEdit>
#include <QPlainTextEdit>
#include <QProcess>
#include <QProgressBar>
#include <QPushButton>
#include <QSettings>
#include <QVBoxLayout>

#include "fit_report.h"
#include "report_view.h"
#include "trimtab/rig/fitted_preset.h"
#include "views/controls/scrollable.h"
#include "views/model/draft.h"

namespace trimtab::workbench {
namespace {

constexpr int kLookMs = 300, kOutputLines = 200;
const QString kCommandKey = QStringLiteral("fit/command");
const QString kPreset = QStringLiteral("{preset}"), kFlight = QStringLiteral("{flight}");

}  // namespace

FitPage::FitPage(views::Draft& draft, LeveragePage::Source source, QWidget* parent)
    : QWidget(parent),
      draft_(draft),
      source_(std::move(source)),
      ig_(new QLabel),
      command_(new QLineEdit(QSettings().value(kCommandKey).toString())),
      flight_(new QLineEdit),
      profile_(new QPushButton(tr("&Profile…"))),
      choose_(new QPushButton(tr("Ch&oose…"))),
      run_(new QPushButton(tr("Fi&t to this image generator"))),
      open_(new QPushButton(tr("Ope&n a fit…"))),
      use_(new QPushButton(tr("&Use fitted preset"))),
      progress_(new QProgressBar),
      status_(new QLabel),
      output_(new QPlainTextEdit),
      report_(new ReportView(tr("What each lever is worth in the image generator"))) {
  auto* outside = new QVBoxLayout(this);
  outside->setContentsMargins(0, 0, 0, 0);
  // A low dock scrolls: the image keeps its half of the window.
  outside->addWidget(views::scrollable(makeContent(), tr("Fit to an image generator")));
  looks_.setInterval(kLookMs);
  connect(&looks_, &QTimer::timeout, this, &FitPage::showProgress);
  connect(profile_, &QPushButton::clicked, this, &FitPage::profileAsked);
  connect(choose_, &QPushButton::clicked, this, [this] {
    const QString file = QFileDialog::getOpenFileName(this, tr("Flight of the fit"));
    if (!file.isEmpty()) flight_->setText(file);
  });
  connect(run_, &QPushButton::clicked, this, [this] { running() ? cancel() : run(); });
  connect(open_, &QPushButton::clicked, this, &FitPage::askOpen);
  connect(use_, &QPushButton::clicked, this, &FitPage::use);
  connect(&child_, &ChildRun::workingChanged, this, &FitPage::showRunning);
  connect(&child_, &ChildRun::ended, this, &FitPage::onEnded);
  connect(&child_, &ChildRun::said, output_, [this](const QString& text) {
    output_->moveCursor(QTextCursor::End);
    output_->insertPlainText(text);
    output_->ensureCursorVisible();
  });
  connect(&draft_, &views::Draft::imageGeneratorChanged, this, &FitPage::showImageGenerator);
  showImageGenerator();
}

QWidget* FitPage::makeContent() {
  command_->setPlaceholderText(tr("viewer --preset {preset} --flight {flight}"));
  command_->setToolTip(
      tr("How the image generator is started; it has to link the library of Trimtab. {preset} becomes the "
         "file of the preset, limited to the image generator, and {flight} that of the flight"));
  flight_->setPlaceholderText(tr("the open flight"));
  flight_->setToolTip(tr("What the image generator flies: the open flight, or another file"));
  profile_->setToolTip(tr("Opens the profile that says which levers the image generator has"));
  open_->setToolTip(tr("Shows a fit that an image generator has written before, without running it"));
  use_->setToolTip(
      tr("Moves the terms of the preset to the load of the image generator, and its losses to "
         "those that were seen, as one step that Undo takes back"));
  status_->setWordWrap(true);
  status_->setTextInteractionFlags(Qt::TextSelectableByMouse);
  output_->setObjectName(QStringLiteral("output"));
  output_->setReadOnly(true);
  output_->setTabChangesFocus(true);
  output_->setMaximumBlockCount(kOutputLines);
  output_->setAccessibleName(tr("Output of the image generator"));
  output_->setPlaceholderText(tr("What the image generator writes"));
  output_->setFixedHeight(5 * fontMetrics().lineSpacing());
  report_->setMinimumHeight(10 * fontMetrics().lineSpacing());
  auto* form = new QFormLayout;
  const auto addRow = [&](const QString& text, QWidget* buddy, QWidget* left, QWidget* right) {
    auto* row = new QHBoxLayout;
    row->addWidget(left, 1);
    if (right != nullptr) row->addWidget(right);
    auto* label = new QLabel(text);
    label->setBuddy(buddy);
    form->addRow(label, row);
  };
  addRow(tr("Image generator"), profile_, ig_, profile_);
  addRow(tr("Co&mmand"), command_, command_, nullptr);
  addRow(tr("Fli&ght"), flight_, flight_, choose_);
  auto* buttons = new QHBoxLayout;
  for (QPushButton* button : {run_, open_, use_}) buttons->addWidget(button);
  buttons->addStretch(1);
  auto* content = new QWidget;
  auto* column = new QVBoxLayout(content);
  column->addLayout(form);
  column->addLayout(buttons);
  column->addWidget(progress_);
  column->addWidget(status_);
  column->addWidget(report_, 1);
  column->addWidget(output_);
  return content;
}

void FitPage::begin() {
  (draft_.imageGenerator() != nullptr ? static_cast<QWidget*>(command_) : profile_)->setFocus();
}

/// A fit of another image generator says nothing of this one.
void FitPage::showImageGenerator() {
  const IgProfile* const ig = draft_.imageGenerator();
  ig_->setText(ig == nullptr ? tr("none yet") : QString::fromStdString(ig->name));
  if (ig != nullptr)
    status_->setText(
        tr("Runs %1, which draws each view of the flight with every lever neutral and then with one "
           "of its %2 levers moved. At least %3 views are needed.")
            .arg(ig_->text())
            .arg(ig->levers.size())
            .arg(kFewestFitViews));
  else
    status_->setText(tr("A fit needs the profile of the image generator: Profile… opens it."));
  if (fit_ && (ig == nullptr || fit_->ig != ig->name)) {
    fit_.reset();
    report_->show({});
  }
  showRunning();
}

void FitPage::showRunning() {
  const bool on = running(), known = draft_.imageGenerator() != nullptr;
  run_->setText(on ? tr("&Cancel") : tr("Fi&t to this image generator"));
  run_->setEnabled(on || known);
  progress_->setVisible(on);
  for (QWidget* each : {static_cast<QWidget*>(command_), static_cast<QWidget*>(flight_),
                        static_cast<QWidget*>(profile_), static_cast<QWidget*>(choose_)})
    each->setEnabled(!on);
  open_->setEnabled(!on && known);
  use_->setEnabled(!on && fit_.has_value());
  if (on)
    looks_.start();
  else
    looks_.stop();
}

QString FitPage::fileOfRun() const {
  return folder_.filePath(QStringLiteral("fit-%1.json").arg(runs_));
}

void FitPage::run() {
  const IgProfile* const ig = draft_.imageGenerator();
  if (running() || ig == nullptr) return;
  QStringList words = QProcess::splitCommand(command_->text());
  if (words.isEmpty())
    return status_->setText(tr("Not started: type the command line of the image generator."));
  const Result<IgProfile> onDisk = loadIgProfile(draft_.imageGeneratorFile().toStdString());
  if (!onDisk || *onDisk != *ig)
    return status_->setText(
        tr("Not started: the image generator would read another profile, because its file has "
           "changed or is gone. Profile… opens it again."));
  const std::optional<ExperimentInputs> inputs = source_(folder_.path());
  if (!inputs) return status_->setText(tr("Not started: the dock Messages says what could not be written."));
  const QString chosen = flight_->text().trimmed();
  const QString flight = chosen.isEmpty() ? inputs->flight : QFileInfo(chosen).absoluteFilePath();
  if (flight.isEmpty() && command_->text().contains(kFlight))
    return status_->setText(tr("Not started: the command names a flight. Ctrl+L opens one."));
  for (QString& word : words) word.replace(kPreset, inputs->preset).replace(kFlight, flight);
  QSettings().setValue(kCommandKey, command_->text());
  ++runs_;
  output_->clear();
  progress_->setRange(0, 0);
  status_->setText(tr("The image generator starts…"));
  const QString program = words.takeFirst();
  child_.start(program, words,
               {{QStringLiteral("TRIMTAB_PROFILE"), draft_.imageGeneratorFile()},
                {QStringLiteral("TRIMTAB_FIT"), fileOfRun()}});
}

void FitPage::cancel() {
  if (!running()) return;
  status_->setText(tr("Cancelling…"));
  child_.cancel();
}

/// The file is there from the first views on.
void FitPage::showProgress() {
  const Result<IgFit> soFar = loadIgFit(fileOfRun().toStdString());
  if (!soFar) return;
  constexpr int kFewest = static_cast<int>(kFewestFitViews);
  const int views = static_cast<int>(soFar->views);
  progress_->setRange(0, kFewest);
  progress_->setValue(std::min(views, kFewest));
  status_->setText(views < kFewest ? tr("%1 of at least %2 views").arg(views).arg(kFewest)
                                   : tr("%1 views: enough, but more make the intervals narrower").arg(views));
}

void FitPage::onEnded(const ChildRun::Ended& how) {
  showRunning();
  Findings findings = how.findings;
  const bool there = QFileInfo::exists(fileOfRun());
  Findings ofFit;
  if (there) ofFit = show(fileOfRun());
  if (!there && how.good)
    ofFit.push_back({Severity::error, child_.name().toStdString(), "TRIMTAB_FIT",
                     "a program that links the library of Trimtab and writes the fit", "no file"});
  // Who cancels before there is anything knows that nothing is there.
  const bool enough = there && ofFit.empty();
  const bool tell = !how.cancelled || !findings.empty();
  if (tell) findings.insert(findings.end(), ofFit.begin(), ofFit.end());
  if (!findings.empty()) emit refused(tr("The image generator was not fitted as asked"), findings);
  if (enough)
    status_->setText(tr("%1 views. %2")
                         .arg(fit_->views)
                         .arg(how.cancelled      ? tr("Cancelled, with enough views for a fit.")
                              : findings.empty() ? tr("Done.")
                                                 : tr("The image generator did not end well: %1")
                                                       .arg(QString::fromStdString(findings.front().found))));
  else
    status_->setText(how.cancelled ? tr("Cancelled with too few views; an earlier fit is kept.")
                                   : tr("Failed: expected %1; found %2.")
                                         .arg(QString::fromStdString(findings.front().expected),
                                              QString::fromStdString(findings.front().found)));
  emit finished(enough);
}

Findings FitPage::show(const QString& file) {
  // A session that is opened while an image generator runs may take the profile away.
  if (draft_.imageGenerator() == nullptr)
    return {{Severity::error, file.toStdString(), {}, "the profile of its image generator", "none"}};
  const IgProfile& ig = *draft_.imageGenerator();
  const Result<IgFit> read = loadIgFit(file.toStdString());
  if (!read) return read.findings();
  if (const auto good = checkFit(*read, ig, file.toStdString()); !good) return good.findings();
  fit_ = *read;
  report_->show(fitReport(*fit_, ig));
  showRunning();
  return {};
}

void FitPage::askOpen() {
  const QString file =
      QFileDialog::getOpenFileName(this, tr("Open a fit"), {}, tr("Fits (*.json);;All files (*)"));
  if (!file.isEmpty()) open(file);
}

void FitPage::open(const QString& file) {
  if (running() || draft_.imageGenerator() == nullptr) return;
  const Findings findings = show(file);
  if (!findings.empty()) emit refused(tr("The fit cannot be used: %1").arg(file), findings);
  status_->setText(findings.empty() ? tr("%1 views, from %2").arg(fit_->views).arg(file)
                                    : tr("The fit cannot be used: expected %1; found %2.")
                                          .arg(QString::fromStdString(findings.front().expected),
                                               QString::fromStdString(findings.front().found)));
}

void FitPage::use() {
  const IgProfile* const ig = draft_.imageGenerator();
  if (!fit_ || ig == nullptr) return;
  const Result<TuningParameters> fitted = fittedTo(*ig, *fit_, draft_.parameters(), draft_.preset().name);
  if (!fitted) return emit refused(tr("The fit cannot be used"), fitted.findings());
  emit chosen(*fitted, fitted.findings(), tr("Fit to %1").arg(QString::fromStdString(ig->name)));
}

}  // namespace trimtab::workbench
