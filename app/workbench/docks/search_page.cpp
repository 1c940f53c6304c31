// SPDX-License-Identifier: GPL-3.0-or-later
#include "search_page.h"

#include <QComboBox>
#include <QCryptographicHash>
#include <QDir>
#include <QDoubleSpinBox>
#include <QFile>
#include <QFileDialog>
#include <QFileInfo>
#include <QFormLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QLineEdit>
#include <QProgressBar>
#include <QPushButton>
#include <QRegularExpression>
#include <QRegularExpressionValidator>
#include <QScrollArea>
#include <QSpinBox>
#include <QTableWidget>
#include <QVBoxLayout>

#include "app/experiment/parse_report.h"
#include "pause_button.h"
#include "report_view.h"
#include "trimtab/preset/file_io.h"

namespace trimtab::workbench {
namespace {

/// What most presets trade time for error by.
const QString kUsuallyFree = QStringLiteral(
    "lod.screen_space_error_px lod.scale objects.error_px objects.small_feature_px hold.enabled");

}  // namespace

SearchPage::SearchPage(LeveragePage::Source source, QWidget* parent)
    : QWidget(parent),
      source_(std::move(source)),
      budget_(new QDoubleSpinBox(this)),
      free_(new QLineEdit(kUsuallyFree, this)),
      heldOut_(new QLineEdit(this)),
      size_(new QLineEdit(QStringLiteral("1280x720"), this)),
      frames_(new QSpinBox(this)),
      evaluations_(new QSpinBox(this)),
      error_(new QComboBox(this)),
      choose_(new QPushButton(tr("C&hoose…"), this)),
      run_(new QPushButton(tr("&Search"), this)),
      use_(new QPushButton(tr("&Use preset"), this)),
      compare_(new QPushButton(tr("Co&mpare"), this)),
      save_(new QPushButton(tr("Sa&ve as…"), this)),
      progress_(new QProgressBar(this)),
      status_(new QLabel(this)),
      report_(new ReportView(tr("Found presets"), this)) {
  budget_->setRange(0, 1000);
  budget_->setDecimals(1);
  budget_->setValue(16.7);
  budget_->setSuffix(tr(" ms"));
  budget_->setSpecialValueText(tr("no limit"));
  budget_->setToolTip(
      tr("95 % of the images may take so long; without a limit presets are spread along the front"));
  free_->setToolTip(
      tr("What may move: keys of parameters, groups as objects.*, or a key within ends of its own as "
         "lod.scale=1..3, with blanks between"));
  heldOut_->setPlaceholderText(tr("none: nothing is proven of other flights"));
  heldOut_->setToolTip(tr("A flight that the search does not see, on which what it found is proven"));
  size_->setValidator(new QRegularExpressionValidator(
      QRegularExpression(QStringLiteral("[1-9][0-9]{1,4}x[1-9][0-9]{1,4}")), size_));
  size_->setToolTip(tr("Render size in pixels"));
  frames_->setRange(1, 100000);
  frames_->setValue(24);
  frames_->setToolTip(tr("Frames of each flight that are drawn of each preset; a 95th percentile needs 20"));
  evaluations_->setRange(100, 10000000);
  evaluations_->setValue(20000);
  evaluations_->setToolTip(tr("Presets that the search estimates"));
  error_->addItem(tr("FLIP"), QStringLiteral("flip"));
  error_->addItem(tr("Geometric, px"), QStringLiteral("geometric"));
  error_->addItem(tr("Pops"), QStringLiteral("pop"));
  error_->setToolTip(
      tr("The error that is made small: mean FLIP, largest geometric error, or 95th percentile of the pops"));
  status_->setWordWrap(true);
  status_->setTextInteractionFlags(Qt::TextSelectableByMouse);

  auto* held = new QHBoxLayout;
  held->addWidget(heldOut_, 1);
  held->addWidget(choose_);
  auto* numbers = new QHBoxLayout;
  numbers->addWidget(budget_);
  const auto labelled = [&](const QString& text, QWidget* field) {
    auto* label = new QLabel(text, this);
    label->setBuddy(field);
    numbers->addWidget(label);
    numbers->addWidget(field);
  };
  labelled(tr("Si&ze"), size_);
  labelled(tr("F&rames"), frames_);
  labelled(tr("&Estimates"), evaluations_);
  labelled(tr("Err&or"), error_);
  numbers->addStretch(1);
  numbers->addWidget(run_);
  numbers->addWidget(makePauseButton(child_, this));
  auto* form = new QFormLayout;
  const auto addRow = [&](const QString& text, QWidget* buddy, auto* field) {
    auto* label = new QLabel(text, this);
    label->setBuddy(buddy);
    form->addRow(label, field);
  };
  addRow(tr("&Free"), free_, free_);
  addRow(tr("He&ld out"), heldOut_, held);
  addRow(tr("&Budget"), budget_, numbers);
  auto* results = new QHBoxLayout;
  results->addWidget(status_, 1);
  for (QPushButton* button : {use_, compare_, save_}) results->addWidget(button);
  auto* content = new QWidget;
  auto* column = new QVBoxLayout(content);
  column->addLayout(form);
  column->addWidget(progress_);
  column->addLayout(results);
  column->addWidget(report_, 1);
  // A low dock scrolls: the image keeps its half of the window.
  auto* scroll = new QScrollArea(this);
  scroll->setWidgetResizable(true);
  scroll->setFrameShape(QFrame::NoFrame);
  scroll->setAccessibleName(tr("Search for presets"));
  scroll->setWidget(content);
  auto* outside = new QVBoxLayout(this);
  outside->setContentsMargins(0, 0, 0, 0);
  outside->addWidget(scroll);

  connect(choose_, &QPushButton::clicked, this, [this] {
    const QString file = QFileDialog::getOpenFileName(this, tr("Flight that the search does not see"));
    if (!file.isEmpty()) heldOut_->setText(file);
  });
  connect(run_, &QPushButton::clicked, this, [this] { running() ? cancel() : run(); });
  connect(use_, &QPushButton::clicked, this, &SearchPage::use);
  connect(compare_, &QPushButton::clicked, this, [this] { emit comparisonAsked(found()); });
  connect(save_, &QPushButton::clicked, this, &SearchPage::askSave);
  connect(&report_->table(), &QTableWidget::itemSelectionChanged, this, &SearchPage::rowSelected);
  connect(&report_->table(), &QTableWidget::cellDoubleClicked, this, &SearchPage::use);
  connect(&child_, &ChildRun::progressed, this, [this](int percent, const QString& what) {
    progress_->setValue(percent);
    status_->setText(what);
  });
  connect(&child_, &ChildRun::ended, this, &SearchPage::onEnded);
  setRunning(false);
  rowSelected();
}

const std::optional<experiment::Report>& SearchPage::report() const {
  return report_->report();
}

void SearchPage::setRunning(bool running) {
  run_->setText(running ? tr("&Cancel") : tr("&Search"));
  progress_->setVisible(running);
  progress_->setValue(0);
  for (QWidget* field :
       {static_cast<QWidget*>(budget_), static_cast<QWidget*>(free_), static_cast<QWidget*>(heldOut_),
        static_cast<QWidget*>(size_), static_cast<QWidget*>(frames_), static_cast<QWidget*>(evaluations_),
        static_cast<QWidget*>(choose_), static_cast<QWidget*>(error_)})
    field->setEnabled(!running);
  if (!running && !report())
    status_->setText(
        tr("Searches presets around the current one along the open flight, and draws what it found on this "
           "machine."));
}

void SearchPage::run() {
  if (running()) return;
  const std::optional<ExperimentInputs> inputs = source_(folder_.path());
  if (!inputs)
    return status_->setText(
        tr("Not started: a search needs an open terrain (Ctrl+T opens one), and the dock Messages says if "
           "its input "
           "could not be written."));
  if (inputs->flight.isEmpty())
    return status_->setText(tr("Not started: a search is made along a flight. Ctrl+L opens one."));
  QStringList arguments{QStringLiteral("tune"),
                        QStringLiteral("--terrain"),
                        inputs->terrain,
                        QStringLiteral("--preset"),
                        inputs->preset,
                        QStringLiteral("--flight"),
                        inputs->flight,
                        QStringLiteral("--size"),
                        size_->text(),
                        QStringLiteral("--frames"),
                        QString::number(frames_->value()),
                        QStringLiteral("--evaluations"),
                        QString::number(evaluations_->value()),
                        QStringLiteral("--error"),
                        error_->currentData().toString(),
                        QStringLiteral("--json")};
  if (budget_->value() > 0) arguments << QStringLiteral("--budget-ms") << QString::number(budget_->value());
  if (!heldOut_->text().trimmed().isEmpty())
    arguments << QStringLiteral("--hold-out") << heldOut_->text().trimmed();
  arguments << QStringLiteral("--free") << free_->text().split(QLatin1Char(' '), Qt::SkipEmptyParts);
  searching_ = folderOf(arguments, *inputs);
  arguments << QStringLiteral("-o") << searching_;
  setRunning(true);
  status_->setText(tr("Starting…"));
  child_.start(arguments);
}

void SearchPage::cancel() {
  if (!running()) return;
  status_->setText(tr("Cancelling…"));
  child_.cancel();
}

void SearchPage::onEnded(const ChildRun::Ended& how) {
  setRunning(false);
  if (how.cancelled) {
    status_->setText(
        tr("Cancelled. Search goes on from what is there, unless a field changes; the earlier results are "
           "kept."));
    emit finished(false);
    return;
  }
  Findings findings = how.findings;
  if (how.good) {
    const Result<experiment::Report> read = experiment::parseReport(
        std::string_view(how.output.constData(), std::size_t(how.output.size())), "trimtab-cli");
    findings = read ? Findings{} : read.findings();
    if (read) {
      shown_ = searching_;
      report_->show(*read);
    }
  }
  if (!findings.empty()) {
    status_->setText(tr("Failed; the earlier results are kept."));
    emit refused(tr("No preset was found"), findings);
    emit finished(false);
    return;
  }
  status_->setText(report()->notes.empty() ? tr("Done") : QString::fromStdString(report()->notes.front()));
  rowSelected();
  emit finished(true);
}

/// Returns the folder of a search, one for each plan: the same search goes on there, and another does not
/// meet it.
QString SearchPage::folderOf(const QStringList& arguments, const ExperimentInputs& inputs) const {
  QCryptographicHash hash(QCryptographicHash::Sha256);
  hash.addData(arguments.join(QLatin1Char('\n')).toUtf8());
  hash.addData(QFileInfo(inputs.terrain).lastModified().toString(Qt::ISODateWithMs).toUtf8());
  for (const QString& name : {inputs.preset, inputs.flight, heldOut_->text().trimmed()})
    if (QFile file(name); !name.isEmpty() && file.open(QIODevice::ReadOnly)) hash.addData(&file);
  return folder_.filePath(QString::fromLatin1(hash.result().toHex().left(16)));
}

/// Returns the file of the preset in the selected row; empty if there is none, or if the search did not find
/// it.
QString SearchPage::found() const {
  const int row = report_->table().currentRow();
  if (!report() || row < 0 || row >= int(report()->measured.rows.size())) return {};
  const QString name = QString::fromStdString(report()->measured.text(std::size_t(row), "preset"));
  const QString file = QStringLiteral("%1/presets/%2.json").arg(shown_, name);
  return QFile::exists(file) ? file : QString();
}

void SearchPage::rowSelected() {
  const QString file = found(), name = QFileInfo(file).completeBaseName();
  const auto show = [&](QPushButton* button, const QString& what) {
    button->setEnabled(!file.isEmpty());
    button->setToolTip(file.isEmpty() ? tr("Select a row of a found preset") : what);
  };
  show(use_, tr("Fly %1; undo takes it back").arg(name));
  show(compare_,
       tr("Draw %1 on the right of the viewport, and the preset that is flown on the left").arg(name));
  show(save_, tr("Copy the file of %1").arg(name));
}

void SearchPage::use() {
  QFile file(found());
  if (found().isEmpty() || !file.open(QIODevice::ReadOnly)) return;
  emit chosen(QFileInfo(file).completeBaseName(), QString::fromUtf8(file.readAll()));
}

void SearchPage::askSave() {
  const QString file = QFileDialog::getSaveFileName(this, tr("Save the found preset"),
                                                    QFileInfo(found()).fileName(), tr("Presets (*.json)"));
  if (!file.isEmpty()) save(file);
}

void SearchPage::save(const QString& file) {
  const Result<std::string> text = readWhole(found().toStdString());
  const Findings failed = text ? writeAtomically(file.toStdString(), *text).findings() : text.findings();
  if (!failed.empty()) return emit refused(tr("The preset cannot be saved: %1").arg(file), failed);
  status_->setText(tr("Saved %1").arg(QDir::toNativeSeparators(file)));
}

}  // namespace trimtab::workbench
