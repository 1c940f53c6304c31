// SPDX-License-Identifier: GPL-3.0-or-later
#include "leverage_page.h"

#include <QComboBox>
#include <QDir>
#include <QFileDialog>
#include <QHBoxLayout>
#include <QHeaderView>
#include <QLabel>
#include <QLineEdit>
#include <QPlainTextEdit>
#include <QProgressBar>
#include <QPushButton>
#include <QRegularExpression>
#include <QRegularExpressionValidator>
#include <QSpinBox>
#include <QTabWidget>
#include <QTableWidget>
#include <QVBoxLayout>
#include <cmath>

#include "app/experiment/leverage.h"
#include "views/model/theme.h"
#include "views/model/value_text.h"
#include "views/plots/report_plot.h"

namespace trimtab::workbench {
namespace {

QTableWidget* makeTable(const QString& name, QWidget* parent) {
  auto* table = new QTableWidget(parent);
  table->setEditTriggers(QAbstractItemView::NoEditTriggers);
  table->setAlternatingRowColors(true);
  table->verticalHeader()->hide();
  table->verticalHeader()->setDefaultSectionSize(20);
  table->setAccessibleName(name);
  table->setMinimumHeight(48);
  return table;
}

void fill(QTableWidget& table, const experiment::Table& from) {
  table.clear();
  table.setRowCount(int(from.rows.size()));
  table.setColumnCount(int(from.columns.size()));
  for (int c = 0; c < table.columnCount(); ++c) {
    const std::string& column = from.columns[std::size_t(c)];
    table.setHorizontalHeaderItem(c, new QTableWidgetItem(QString::fromStdString(column).replace('_', ' ')));
    for (int r = 0; r < table.rowCount(); ++r) {
      const double number = from.number(std::size_t(r), column);
      const QString text = std::isfinite(number) ? views::numberText(number, std::abs(number) >= 1000 ? 0 : 3)
                                                 : QString::fromStdString(from.text(std::size_t(r), column));
      auto* item = new QTableWidgetItem(text);
      if (std::isfinite(number)) item->setTextAlignment(Qt::AlignRight | Qt::AlignVCenter);
      table.setItem(r, c, item);
    }
  }
  table.resizeColumnsToContents();
}

views::ReportPlotData toView(const experiment::Plot& plot) {
  views::ReportPlotData data{QString::fromStdString(plot.title),
                             QString::fromStdString(plot.xLabel),
                             QString::fromStdString(plot.yLabel),
                             {},
                             {}};
  for (const std::string& category : plot.categories) data.categories << QString::fromStdString(category);
  for (const experiment::Series& s : plot.series)
    data.series.append({QString::fromStdString(s.name), QVector<double>(s.x.begin(), s.x.end()),
                        QVector<double>(s.y.begin(), s.y.end()),
                        QVector<double>(s.yLow.begin(), s.yLow.end()),
                        QVector<double>(s.yHigh.begin(), s.yHigh.end())});
  return data;
}

}  // namespace

LeveragePage::LeveragePage(Source source, QWidget* parent)
    : QWidget(parent),
      source_(std::move(source)),
      plots_(new QComboBox(this)),
      size_(new QLineEdit(QStringLiteral("1280x720"), this)),
      repeats_(new QSpinBox(this)),
      run_(new QPushButton(tr("&Run"), this)),
      save_(new QPushButton(tr("&Save…"), this)),
      progress_(new QProgressBar(this)),
      status_(new QLabel(this)),
      machine_(new QLabel(this)),
      measured_(makeTable(tr("What each lever is worth"), this)),
      plot_(new views::ReportPlot(this)),
      notes_(new QPlainTextEdit(this)) {
  size_->setValidator(new QRegularExpressionValidator(
      QRegularExpression(QStringLiteral("[1-9][0-9]{1,4}x[1-9][0-9]{1,4}")), size_));
  size_->setMaximumWidth(90);
  size_->setToolTip(tr("Render size in pixels. Smaller is faster; compare ratios at one size only"));
  repeats_->setRange(1, 100);
  repeats_->setValue(3);
  repeats_->setSuffix(tr(" frames"));
  repeats_->setToolTip(tr("Frames per view; their median counts"));
  repeats_->setAccessibleName(tr("Frames per view"));
  notes_->setReadOnly(true);
  notes_->setAccessibleName(tr("Notes"));
  machine_->setWordWrap(true);
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
  top->addWidget(save_);

  auto* plotPage = new QWidget(this);
  auto* plotColumn = new QVBoxLayout(plotPage);
  plots_->setAccessibleName(tr("Plot"));
  plotColumn->addWidget(plots_);
  plotColumn->addWidget(plot_, 1);
  auto* tabs = new QTabWidget(this);
  tabs->addTab(measured_, tr("&Table"));
  tabs->addTab(plotPage, tr("&Plots"));
  tabs->addTab(notes_, tr("&Notes"));

  auto* column = new QVBoxLayout(this);
  column->addLayout(top);
  column->addWidget(progress_);
  column->addWidget(status_);
  column->addWidget(tabs, 1);
  column->addWidget(machine_);

  connect(run_, &QPushButton::clicked, this, [this] { running() ? cancel() : run(); });
  connect(save_, &QPushButton::clicked, this, &LeveragePage::save);
  connect(plots_, &QComboBox::currentIndexChanged, this, &LeveragePage::showPlot);
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
  if (!running && !report_)
    status_->setText(
        tr("Measures along the open flight with the current preset, on this machine. Other programs disturb "
           "the times."));
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
      report_ = experiment::toReport(*read);
    }
  }
  if (!findings.empty()) {
    status_->setText(tr("Failed; the earlier results are kept."));
    emit refused(tr("Leverage was not measured"), findings);
    emit finished(false);
    return;
  }
  status_->setText(tr("Done"));
  show(*report_);
  emit finished(true);
}

void LeveragePage::show(const experiment::Report& report) {
  fill(*measured_, report.measured);
  machine_->setText(QString::fromStdString(report.machine));
  QStringList notes;
  for (const std::string& note : report.notes) notes << QString::fromStdString(note);
  notes_->setPlainText(notes.join(QStringLiteral("\n\n")));
  plots_->clear();
  for (const experiment::Plot& plot : report.plots) plots_->addItem(QString::fromStdString(plot.title));
  save_->setEnabled(true);
}

void LeveragePage::showPlot(int index) {
  if (!report_ || index < 0 || index >= int(report_->plots.size())) return plot_->clear();
  plot_->show(toView(report_->plots[std::size_t(index)]));
}

void LeveragePage::save() {
  const QString folder = QFileDialog::getExistingDirectory(this, tr("Folder for tables and plots"));
  if (folder.isEmpty() || !report_) return;
  const auto written = experiment::writeReport(folder.toStdString(), *report_);
  if (!written.findings().empty())
    emit refused(written ? tr("The results are saved") : tr("The results cannot be saved"),
                 written.findings());
  if (written) status_->setText(tr("Saved to %1").arg(QDir::toNativeSeparators(folder)));
}

}  // namespace trimtab::workbench
