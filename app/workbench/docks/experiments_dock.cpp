// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments_dock.h"

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
#include <QSplitter>
#include <QTabWidget>
#include <QTableWidget>
#include <QVBoxLayout>
#include <algorithm>
#include <cmath>

#include "app/experiment/leverage.h"
#include "views/model/theme.h"
#include "views/model/value_text.h"
#include "views/plots/report_plot.h"

namespace trimtab::workbench {
namespace {

struct Named {
  const char *command, *label, *documents;
};
constexpr char kLeverage[] = "leverage";
constexpr Named kExperiments[] = {
    {"culling", QT_TRANSLATE_NOOP("ExperimentsDock", "Culling: none, view frustum, proposed"), "A, B"},
    {"culling-per-node", QT_TRANSLATE_NOOP("ExperimentsDock", "Culling: decided by frame or by node"), "A"},
    {"head-motion", QT_TRANSLATE_NOOP("ExperimentsDock", "Head motion: a sweep of 180° in 1 s"), "C"},
    {"head-motion-varying",
     QT_TRANSLATE_NOOP("ExperimentsDock", "Head motion: turns and nods of varying speed"), "C"},
    {"weather", QT_TRANSLATE_NOOP("ExperimentsDock", "Weather: fixed and adaptive ratio"), "D"},
    {"weather-protocol", QT_TRANSLATE_NOOP("ExperimentsDock", "Weather: one ratio at several vertex counts"),
     "D"},
    {"static-lod", QT_TRANSLATE_NOOP("ExperimentsDock", "Static LOD: faces by level"), "E"},
    {kLeverage, QT_TRANSLATE_NOOP("ExperimentsDock", "Leverage: what each lever is worth in this flight"),
     ""},
};

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

/// Reads what the command printed.
Result<experiment::Report> reportIn(std::string_view json, bool leverage) {
  if (!leverage) return experiment::parseReport(json, "trimtab-cli");
  const Result<experiment::Leverage> read = experiment::parseLeverage(json, "trimtab-cli");
  if (!read) return read.findings();
  return experiment::toReport(*read);
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

ExperimentsDock::ExperimentsDock(Source source, QWidget* parent)
    : QWidget(parent),
      source_(std::move(source)),
      which_(new QComboBox(this)),
      plots_(new QComboBox(this)),
      size_(new QLineEdit(QStringLiteral("1280x720"), this)),
      repeats_(new QSpinBox(this)),
      run_(new QPushButton(tr("&Run"), this)),
      save_(new QPushButton(tr("&Save…"), this)),
      progress_(new QProgressBar(this)),
      status_(new QLabel(this)),
      machine_(new QLabel(this)),
      published_(makeTable(tr("Published rows"), this)),
      measured_(makeTable(tr("Measured rows"), this)),
      plot_(new views::ReportPlot(this)),
      notes_(new QPlainTextEdit(this)) {
  for (const Named& each : kExperiments) {
    which_->addItem(tr(each.label), QLatin1String(each.command));
    which_->setItemData(which_->count() - 1,
                        QStringLiteral("%1%2").arg(tr(each.label), views::documentsHtml(each.documents)),
                        Qt::ToolTipRole);
  }
  which_->setAccessibleName(tr("Experiment"));
  which_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  size_->setValidator(new QRegularExpressionValidator(
      QRegularExpression(QStringLiteral("[1-9][0-9]{1,4}x[1-9][0-9]{1,4}")), size_));
  size_->setMaximumWidth(90);
  size_->setToolTip(tr("Render size in pixels. Smaller is faster; compare ratios at one size only"));
  repeats_->setRange(1, 100);
  repeats_->setValue(3);
  repeats_->setSuffix(tr(" frames"));
  repeats_->setToolTip(
      tr("Frames per view; their median counts. Head motion flies so many passes, and six tell whether it "
         "gains"));
  repeats_->setAccessibleName(tr("Frames per view"));
  notes_->setReadOnly(true);
  notes_->setAccessibleName(tr("Notes"));
  machine_->setWordWrap(true);
  status_->setWordWrap(true);
  save_->setEnabled(false);

  auto* top = new QHBoxLayout;
  top->addWidget(which_, 1);
  auto* sizeLabel = new QLabel(tr("Si&ze"), this);
  sizeLabel->setBuddy(size_);
  top->addWidget(sizeLabel);
  top->addWidget(size_);
  top->addWidget(repeats_);
  top->addWidget(run_);
  top->addWidget(save_);

  const auto titled = [this](const QString& title, QTableWidget* table) {
    auto* box = new QWidget(this);
    auto* column = new QVBoxLayout(box);
    column->setContentsMargins(0, 0, 0, 0);
    column->addWidget(new QLabel(title, box));
    column->addWidget(table);
    return box;
  };
  auto* tables = new QSplitter(Qt::Horizontal, this);
  tables->addWidget(titled(tr("Published"), published_));
  tables->addWidget(titled(tr("Measured here"), measured_));
  auto* plotPage = new QWidget(this);
  auto* plotColumn = new QVBoxLayout(plotPage);
  plots_->setAccessibleName(tr("Plot"));
  plotColumn->addWidget(plots_);
  plotColumn->addWidget(plot_, 1);
  auto* tabs = new QTabWidget(this);
  tabs->addTab(tables, tr("&Tables"));
  tabs->addTab(plotPage, tr("&Plots"));
  tabs->addTab(notes_, tr("&Notes"));

  auto* column = new QVBoxLayout(this);
  column->addLayout(top);
  column->addWidget(progress_);
  column->addWidget(status_);
  column->addWidget(tabs, 1);
  column->addWidget(machine_);

  connect(run_, &QPushButton::clicked, this, [this] { running() ? cancel() : run(); });
  connect(save_, &QPushButton::clicked, this, &ExperimentsDock::save);
  const auto explain = [this] {
    which_->setToolTip(which_->itemData(which_->currentIndex(), Qt::ToolTipRole).toString());
  };
  explain();
  connect(which_, &QComboBox::currentIndexChanged, this, [this, explain] {
    if (which_->currentData().toString().startsWith(QLatin1String("head-motion")))
      repeats_->setValue(std::max(repeats_->value(), 6));
    explain();
    if (status_->text() == refusal_) status_->setText(hint());
  });
  connect(plots_, &QComboBox::currentIndexChanged, this, &ExperimentsDock::showPlot);
  connect(&child_, &ChildRun::progressed, this, [this](int percent, const QString& what) {
    progress_->setValue(percent);
    status_->setText(what);
  });
  connect(&child_, &ChildRun::ended, this, &ExperimentsDock::onEnded);
  setRunning(false);
}

void ExperimentsDock::setRunning(bool running) {
  run_->setText(running ? tr("&Cancel") : tr("&Run"));
  progress_->setVisible(running);
  progress_->setValue(0);
  for (QWidget* input :
       {static_cast<QWidget*>(which_), static_cast<QWidget*>(size_), static_cast<QWidget*>(repeats_)})
    input->setEnabled(!running);
  if (!running && !report_) status_->setText(hint());
}

QString ExperimentsDock::hint() const {
  if (report_) return {};
  return tr(
      "Runs over the open terrain, the open flight and the current preset, on this machine. Other programs "
      "disturb the times.");
}

void ExperimentsDock::run() {
  if (running()) return;
  const std::optional<ExperimentInputs> inputs = source_(folder_.path());
  if (!inputs)
    return refuse(tr(
        "Not started: an experiment needs an open terrain (Ctrl+T opens one), and the dock Messages says if "
        "its input could not be written."));
  const QString command = which_->currentData().toString();
  const bool leverage = command == QLatin1String(kLeverage);
  if (leverage && inputs->flight.isEmpty())
    return refuse(tr("Not started: leverage is measured along a flight. Ctrl+L opens one."));
  QStringList arguments;
  if (!leverage) arguments << QStringLiteral("experiment");
  arguments << command << QStringLiteral("--terrain") << inputs->terrain << QStringLiteral("--preset")
            << inputs->preset << QStringLiteral("--size") << size_->text() << QStringLiteral("--repeats")
            << QString::number(repeats_->value()) << QStringLiteral("--json");
  if (!inputs->flight.isEmpty()) arguments << QStringLiteral("--flight") << inputs->flight;
  setRunning(true);
  status_->setText(tr("Starting…"));
  child_.start(arguments);
}

/// What a person has to do first stands here, where the person looks: the Messages dock would cover it.
void ExperimentsDock::refuse(const QString& why) {
  refusal_ = why;
  status_->setText(why);
}

void ExperimentsDock::cancel() {
  if (!running()) return;
  status_->setText(tr("Cancelling…"));
  child_.cancel();
}

void ExperimentsDock::onEnded(const ChildRun::Ended& how) {
  setRunning(false);
  const QString name = which_->currentText();
  if (how.cancelled) {
    status_->setText(tr("Cancelled; the earlier results are kept."));
    emit finished(false);
    return;
  }
  Findings findings = how.findings;
  if (how.good) {
    Result<experiment::Report> report =
        reportIn(std::string_view(how.output.constData(), std::size_t(how.output.size())),
                 which_->currentData().toString() == QLatin1String(kLeverage));
    findings = report.findings();
    if (report) {
      findings.clear();  // notes
      report_ = std::move(report).value();
    }
  }
  if (!findings.empty()) {
    status_->setText(tr("Failed; the earlier results are kept."));
    emit refused(tr("The experiment failed"), findings);
    emit finished(false);
    return;
  }
  status_->setText(tr("Done: %1").arg(name));
  show(*report_);
  emit finished(true);
}

void ExperimentsDock::show(const experiment::Report& report) {
  fill(*published_, report.published);
  // No document has published leverage.
  published_->parentWidget()->setVisible(!report.published.rows.empty());
  fill(*measured_, report.measured);
  machine_->setText(QString::fromStdString(report.machine));
  QStringList notes;
  for (const std::string& note : report.notes) notes << QString::fromStdString(note);
  notes_->setPlainText(notes.join(QStringLiteral("\n\n")));
  plots_->clear();
  for (const experiment::Plot& plot : report.plots) plots_->addItem(QString::fromStdString(plot.title));
  save_->setEnabled(true);
}

void ExperimentsDock::showPlot(int index) {
  if (!report_ || index < 0 || index >= int(report_->plots.size())) return plot_->clear();
  plot_->show(toView(report_->plots[std::size_t(index)]));
}

void ExperimentsDock::save() {
  const QString folder = QFileDialog::getExistingDirectory(this, tr("Folder for tables and plots"));
  if (folder.isEmpty() || !report_) return;
  const auto written = experiment::writeReport(folder.toStdString(), *report_);
  if (!written.findings().empty())
    emit refused(written ? tr("The results are saved") : tr("The results cannot be saved"),
                 written.findings());
  if (written) status_->setText(tr("Saved to %1").arg(QDir::toNativeSeparators(folder)));
}

}  // namespace trimtab::workbench
