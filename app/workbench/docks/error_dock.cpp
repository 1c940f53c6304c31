// SPDX-License-Identifier: GPL-3.0-or-later
#include "error_dock.h"

#include <QCheckBox>
#include <QComboBox>
#include <QDateTime>
#include <QDesktopServices>
#include <QDir>
#include <QFile>
#include <QFileDialog>
#include <QFileInfo>
#include <QGridLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QProgressBar>
#include <QPushButton>
#include <QSplitter>
#include <QStandardPaths>
#include <QTabWidget>
#include <QUrl>
#include <QVBoxLayout>
#include <algorithm>
#include <cmath>

#include "answer_page.h"
#include "measured_run.h"
#include "pause_button.h"
#include "sweep_page.h"
#include "trimtab/preset/file_io.h"
#include "views/model/theme.h"

namespace trimtab::workbench {
namespace {

constexpr int kControlsPx = 214;
constexpr auto kFirstError = "flip";

/// Where results are kept unless the person says otherwise.
QString newFolder() {
  return QStandardPaths::writableLocation(QStandardPaths::AppLocalDataLocation) + QStringLiteral("/bench/") +
         QDateTime::currentDateTime().toString(QStringLiteral("yyyy-MM-dd-hhmmss"));
}

}  // namespace

ErrorDock::ErrorDock(views::Draft& draft, DrawThread& thread, LiveMeter::Source live, Source source,
                     QWidget* parent)
    : QWidget(parent),
      draft_(draft),
      source_(std::move(source)),
      live_(thread, std::move(live)),
      errors_(new QComboBox(this)),
      flights_(new QComboBox(this)),
      cases_(new QComboBox(this)),
      logarithmic_(new QCheckBox(tr("Lo&g scale"), this)),
      liveOn_(new QCheckBox(tr("Meas&ure live"), this)),
      measure_(new QPushButton(this)),
      open_(new QPushButton(tr("Open re&sults..."), this)),
      report_(new QPushButton(tr("Open repor&t"), this)),
      compare_(new QPushButton(tr("Compare two..."), this)),
      openFlight_(new QPushButton(tr("Open a flight..."), this)),
      progress_(new QProgressBar(this)),
      status_(new QLabel(this)),
      liveLabel_(new QLabel(this)),
      plot_(new views::ErrorPlot(this)),
      timeline_(new views::ErrorTimeline(this)),
      answer_(new AnswerPage(this)),
      sweep_(new SweepPage(this)),
      pages_(new QTabWidget(this)) {
  const views::ErrorRun nothing{measuredErrors(), {}};
  for (const views::ErrorRun::Error& error : nothing.errors) errors_->addItem(titleOf(error), error.key);
  errors_->setCurrentIndex(std::max(0, errors_->findData(QLatin1String(kFirstError))));
  errors_->setAccessibleName(tr("Error"));
  errors_->setToolTip(tr("Error that the plots show"));
  flights_->setAccessibleName(tr("Flight"));
  flights_->setToolTip(tr("Measured flight that the plots show"));
  cases_->setAccessibleName(tr("Culling case"));
  cases_->setToolTip(tr("Culling case along the flight"));
  for (QComboBox* box : {errors_, flights_, cases_}) {
    box->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
    box->setMinimumContentsLength(6);
  }
  logarithmic_->setToolTip(tr("Shows the frame time on a logarithmic scale"));
  liveOn_->setChecked(true);
  liveOn_->setToolTip(
      tr("About once a second, draws the current image and its reference again on another processor "
         "core, and compares them"));
  open_->setToolTip(tr("Opens the results.json that trimtab-cli bench writes"));
  compare_->setToolTip(tr("Shows two presets on the current frame, with a map of their differences"));
  status_->setWordWrap(true);
  liveLabel_->setWordWrap(true);
  liveLabel_->setAccessibleName(tr("Live measurement"));
  plot_->show(nothing);
  timeline_->show(nothing);
  arrange();

  connect(errors_, &QComboBox::currentIndexChanged, this, [this](int index) {
    plot_->showError(index);
    timeline_->showError(index);
    liveLabel_->setText(liveText());
  });
  connect(flights_, &QComboBox::currentTextChanged, this, [this](const QString& flight) {
    plot_->showFlight(flight);
    timeline_->showFlight(flight);
    showAnswer();
    flights_->setToolTip(tr("Measured flight that the plots show: %1").arg(flight));
    emit flightShown();
  });
  connect(cases_, &QComboBox::currentIndexChanged, this,
          [this] { timeline_->showMethod(cases_->currentData().toString()); });
  connect(logarithmic_, &QCheckBox::toggled, plot_, &views::ErrorPlot::setLogarithmic);
  connect(plot_, &views::ErrorPlot::logarithmicChanged, logarithmic_, &QCheckBox::setChecked);
  connect(liveOn_, &QCheckBox::toggled, this, [this](bool on) {
    measureIfWanted();
    if (!on) restartLive();
    liveLabel_->setText(liveText());
  });
  connect(measure_, &QPushButton::clicked, this, [this] { running() ? cancel() : askAndMeasure(); });
  connect(open_, &QPushButton::clicked, this, &ErrorDock::askOpenResults);
  connect(report_, &QPushButton::clicked, this, &ErrorDock::openReport);
  connect(compare_, &QPushButton::clicked, this, &ErrorDock::comparisonAsked);
  connect(openFlight_, &QPushButton::clicked, this, &ErrorDock::flightAsked);
  connect(timeline_, &views::ErrorTimeline::sought, this, &ErrorDock::sought);
  connect(&live_, &LiveMeter::measured, this, &ErrorDock::onMeasured);
  connect(&child_, &ChildRun::progressed, this, [this](int percent, const QString& what) {
    progress_->setValue(percent);
    status_->setText(what);
  });
  connect(&child_, &ChildRun::ended, this, &ErrorDock::onEnded);
  connect(&draft_, &views::Draft::activeChanged, this, [this] {
    showBudget();
    live_.forget();
  });
  plot_->showError(errors_->currentIndex());
  timeline_->showError(errors_->currentIndex());
  showBudget();
  setRunning(false);
  showResults();
}

/// Puts the controls into a column on the left, because the dock is wide and low.
void ErrorDock::arrange() {
  auto* controls = new QWidget(this);
  controls->setFixedWidth(kControlsPx);
  auto* grid = new QGridLayout(controls);
  grid->setContentsMargins(0, 0, 0, 0);
  grid->setVerticalSpacing(3);
  // Choices have all the width that their names leave: a flight's name is long.
  auto* choices = new QGridLayout;
  choices->setVerticalSpacing(3);
  choices->setHorizontalSpacing(6);
  choices->setColumnStretch(1, 1);
  const auto named = [&](const QString& text, QComboBox* box) {
    auto* label = new QLabel(text, controls);
    label->setBuddy(box);
    const int at = choices->rowCount();
    choices->addWidget(label, at, 0);
    choices->addWidget(box, at, 1);
  };
  named(tr("Erro&r"), errors_);
  named(tr("Fl&ight"), flights_);
  named(tr("C&ase"), cases_);
  int row = 0;
  grid->addLayout(choices, row++, 0, 1, 2);
  grid->addWidget(logarithmic_, row, 0);
  grid->addWidget(liveOn_, row++, 1);
  grid->addWidget(measure_, row, 0);
  grid->addWidget(open_, row++, 1);
  grid->addWidget(report_, row, 0);
  grid->addWidget(compare_, row++, 1);
  grid->addWidget(openFlight_, row++, 0, 1, 2);
  grid->addWidget(progress_, row, 0);
  grid->addWidget(makePauseButton(child_, controls), row++, 1);
  grid->addWidget(status_, row++, 0, 1, 2);
  grid->addWidget(liveLabel_, row++, 0, 1, 2);
  grid->setRowStretch(row, 1);

  auto* plots = new QSplitter(Qt::Horizontal, this);
  plots->addWidget(plot_);
  plots->addWidget(timeline_);
  plots->setChildrenCollapsible(false);
  auto* all = new QHBoxLayout(this);
  all->setContentsMargins(6, 4, 4, 4);
  all->addWidget(controls);
  pages_->setDocumentMode(true);
  pages_->addTab(answer_, tr("Which preset fits"));
  pages_->addTab(sweep_, tr("Sweep"));
  pages_->addTab(plots, tr("Plots"));
  pages_->setCurrentWidget(plots);
  all->addWidget(pages_, 1);
}

void ErrorDock::setSeen(bool seen) {
  seen_ = seen;
  measureIfWanted();
}

void ErrorDock::setWatched(const QObject* who, bool watched) {
  if (watched)
    watchers_.insert(who);
  else
    watchers_.erase(who);
  measureIfWanted();
}

void ErrorDock::measureIfWanted() {
  const bool wanted = (seen_ || !watchers_.empty()) && liveOn_->isChecked();
  live_.setOn(wanted);
  if (!wanted) emit flipChanged(FrameError::kNotMeasured);
}

QString ErrorDock::flight() const {
  return flights_->currentText();
}

void ErrorDock::painted(double time, double frameMs) {
  live_.painted(time, frameMs);
}

void ErrorDock::restartLive() {
  plot_->clearLive();
  lastMeasured_.reset();
  emit flipChanged(FrameError::kNotMeasured);
  live_.forget();
}

void ErrorDock::followFlight(double timeS) {
  if (seen_) timeline_->follow(timeS);
}

void ErrorDock::showBudget() {
  const double ms = draft_.active()->measure.budget.value();
  plot_->setBudget(ms);
  timeline_->setBudget(ms);
  if (!answer_->answer() || answer_->answer()->budgetMs != ms) showAnswer();
}

/// Judges the results by the draft's budget, so that the best preset is named anew as a person changes it.
void ErrorDock::showAnswer() {
  if (!results_ || flight().isEmpty()) {
    sweep_->clear();
    return answer_->clear();
  }
  answer_->show(*results_, flight(), draft_.active()->measure.budget.value());
  sweep_->show(*results_, *answer_->answer());
}

void ErrorDock::onMeasured(const LiveMeter::Measured& measured) {
  lastMeasured_ = measured;
  emit flipChanged(measured.error.flip);
  plot_->showLive(
      {measured.frameMs, errorsOf(measured.error), measured.imageWidthPx, measured.imageHeightPx});
  liveLabel_->setText(liveText());
}

QString ErrorDock::liveText() const {
  if (!liveOn_->isChecked()) return tr("Live: off");
  if (!lastMeasured_) return tr("Live: waiting for an image");
  const int index = errors_->currentIndex();
  const QVector<views::ErrorRun::Error> errors = measuredErrors();
  if (index < 0 || index >= errors.size()) return {};
  return tr("Live: %1 %2, frame %3.\nMeasured in %4 at %L5 × %L6 px%7.")
      .arg(errors[index].label, textOf(errors[index], errorsOf(lastMeasured_->error)[index]),
           views::msText(lastMeasured_->frameMs), views::msText(lastMeasured_->tookMs))
      .arg(lastMeasured_->widthPx)
      .arg(lastMeasured_->heightPx)
      .arg(lastMeasured_->smaller ? tr(", smaller because it takes long") : QString());
}

void ErrorDock::setRunning(bool running) {
  measure_->setText(running ? tr("&Cancel") : tr("&Measure..."));
  measure_->setToolTip(
      running ? tr("What has been measured is kept; measuring into the same folder resumes")
              : tr("Measure presets along the open flight, or the recorded trace, over the open terrain"));
  measure_->setAccessibleName(running ? tr("Cancel measuring") : tr("Measure presets"));
  progress_->setVisible(running);
  progress_->setValue(0);
  open_->setEnabled(!running);
}

void ErrorDock::setMissing(const QString& what) {
  if (status_->text() == missing_) status_->setText(what);
  missing_ = what;
  openFlight_->setVisible(!what.isEmpty());
}

void ErrorDock::askAndMeasure() {
  if (!missing_.isEmpty()) {
    status_->setText(missing_);
    return openFlight_->setFocus();
  }
  BenchDialog dialog(newFolder(), this);
  if (dialog.exec() == QDialog::Accepted) measure(dialog.choice());
}

void ErrorDock::measure(const BenchChoice& choice) {
  if (running()) return;
  const std::optional<Inputs> inputs = source_(folder_.path());
  if (!inputs) return;
  measuring_ = choice.folder + QStringLiteral("/results.json");
  setRunning(true);
  status_->setText(tr("Starting…"));
  child_.start(choice.arguments(inputs->terrain, inputs->flight, inputs->draft));
}

void ErrorDock::cancel() {
  if (!running()) return;
  status_->setText(tr("Cancelling…"));
  child_.cancel();
}

void ErrorDock::onEnded(const ChildRun::Ended& how) {
  setRunning(false);
  if (how.cancelled) {
    status_->setText(tr("Cancelled. Measure into the same folder again to resume."));
    status_->setToolTip(QFileInfo(measuring_).path());
    return emit finished(false);
  }
  if (!how.good) {
    status_->setText(tr("Failed; the earlier results are kept."));
    emit refused(tr("The presets cannot be measured"), how.findings);
    return emit finished(false);
  }
  emit finished(openResults(measuring_));
}

void ErrorDock::askOpenResults() {
  const QString file =
      QFileDialog::getOpenFileName(this, tr("Open results"), resultsFile_, tr("Results (*.json)"));
  if (!file.isEmpty()) openResults(file);
}

bool ErrorDock::openResults(const QString& file) {
  const auto refuse = [&](const Findings& findings) {
    emit refused(tr("The results cannot be opened: %1").arg(file), findings);
    return false;
  };
  const Result<std::string> bytes = readWhole(file.toStdString(), kLargestRecording);
  if (!bytes) return refuse(bytes.findings());
  Result<harness::Results> read = harness::parseResults(*bytes, file.toStdString());
  if (!read) return refuse(read.findings());
  results_ = std::move(read).value();
  resultsFile_ = QFileInfo(file).absoluteFilePath();
  showResults();
  // A sweep has the answer in it.
  pages_->setCurrentWidget(sweep_->sweeps() > 0 ? static_cast<QWidget*>(sweep_) : answer_);
  return true;
}

void ErrorDock::showResults() {
  report_->setEnabled(!report().isEmpty());
  report_->setToolTip(report().isEmpty() ? tr("There is no report.html beside the results") : report());
  const views::ErrorRun run = results_ ? measuredRun(*results_) : views::ErrorRun{measuredErrors(), {}, 0, 0};
  plot_->show(run);
  timeline_->show(run);
  flights_->clear();
  flights_->addItems(run.flights());
  cases_->clear();
  for (const QString& method : run.methods()) cases_->addItem(views::methodText(method), method);
  cases_->setCurrentIndex(cases_->count() - 1);
  flights_->setEnabled(flights_->count() > 1);
  cases_->setEnabled(cases_->count() > 1);
  // The dock is low: what there is nothing to choose from takes no place.
  for (QLabel* label : findChildren<QLabel*>())
    if (const auto* box = qobject_cast<QComboBox*>(label->buddy());
        box != nullptr && (box == flights_ || box == cases_)) {
      label->setVisible(box->count() > 0);
      label->buddy()->setVisible(box->count() > 0);
    }
  if (results_)
    status_->setText(tr("%1, %2 × %3 px")
                         .arg(QString::fromStdString(results_->terrain))
                         .arg(results_->widthPx)
                         .arg(results_->heightPx));
  status_->setToolTip(results_ ? tr("%1\n%2").arg(resultsFile_, QString::fromStdString(results_->machine))
                               : QString());
  liveLabel_->setText(liveText());
}

QString ErrorDock::report() const {
  if (resultsFile_.isEmpty()) return {};
  const QString file = QFileInfo(resultsFile_).path() + QStringLiteral("/report.html");
  return QFileInfo::exists(file) ? file : QString();
}

void ErrorDock::openReport() {
  const QString file = report();
  if (file.isEmpty() || QDesktopServices::openUrl(QUrl::fromLocalFile(file))) return;
  emit refused(tr("The report cannot be shown"),
               {{Severity::error, file.toStdString(), {}, "a program that shows HTML", "none that starts"}});
}

}  // namespace trimtab::workbench
