// SPDX-License-Identifier: GPL-3.0-or-later
#include "weather_wizard.h"

#include <QCoreApplication>
#include <QHBoxLayout>
#include <QHeaderView>
#include <QLabel>
#include <QListWidget>
#include <QProgressBar>
#include <QPushButton>
#include <QSpinBox>
#include <QTabWidget>
#include <QTableWidget>
#include <QVBoxLayout>
#include <cmath>

#include "views/model/theme.h"
#include "views/plots/report_plot.h"

namespace trimtab::workbench {
namespace {

/// An image that still builds tiles is drawn again, but not for ever.
constexpr int kMostWarmUp = 60;
/// Decisions that a step is measured with at the most, for the progress bar.
constexpr int kMostDecisions = 16;
/// The height of the plot, pixels, leaves room for the labels around its bars.
constexpr int kPlotHeight = 240;

enum Column {
  kStep,
  kOutcome,
  kLoss,
  kLossFps,
  kGain,
  kFar,
  kRatio,
  kDensity,
  kMatched,
  kMatchedFps,
  kColumns
};

QString stepLabel(WeatherStep step) {
  const std::string_view label = findRow("weather.step")->choices[static_cast<std::size_t>(step)].label;
  return views::fromView(label);
}

QString ms(double value) {
  return views::numberText(value, 2);
}
QString fps(double milliseconds) {
  return milliseconds > 0 ? views::numberText(1000 / milliseconds, 1) : QString();
}

QString outcomeText(const StepCalibration& c) {
  const std::string_view text = toText(c.outcome);
  QString said = views::fromView(text);
  if (c.outcome == CalibrationOutcome::cut_not_enough && c.density > 0)
    said = WeatherWizard::tr("Costs more than any cut can win (%1 of %2 ms): density %3 fits")
               .arg(ms(c.strongestGainMs()), ms(c.lossMs()), views::numberText(c.density, 3));
  else if (c.outcome == CalibrationOutcome::cut_not_enough)
    said = WeatherWizard::tr("Costs more than any cut can win (%1 of %2 ms): no particles fit")
               .arg(ms(c.strongestGainMs()), ms(c.lossMs()));
  else if (c.outcome == CalibrationOutcome::fog_not_enough)
    said = WeatherWizard::tr("Costs more than any cut can win (%1 of %2 ms), even without particles")
               .arg(ms(c.strongestGainMs()), ms(c.lossMs()));
  if (const std::string why = whyRejected(c); !why.empty() && why != text)
    said += WeatherWizard::tr("; rejected: %1").arg(QString::fromStdString(why));
  if (!said.isEmpty()) said[0] = said[0].toUpper();
  return said;
}

}  // namespace

WeatherWizard::WeatherWizard(views::Draft& draft, WeatherStage stage, QWidget* parent)
    : QDialog(parent),
      draft_(draft),
      stage_(std::move(stage)),
      steps_(new QListWidget(this)),
      frames_(new QSpinBox(this)),
      run_(new QPushButton(this)),
      write_(new QPushButton(tr("&Write to the preset"), this)),
      rejected_(new QLabel(this)),
      close_(new QPushButton(tr("Close"), this)),
      progress_(new QProgressBar(this)),
      status_(new QLabel(this)),
      table_(new QTableWidget(0, kColumns, this)),
      plot_(new views::ReportPlot(this)) {
  setWindowTitle(tr("Calibrate weather"));
  auto* intro = new QLabel(
      tr("Draws the current view in clear air and in each weather step, without the cut and with the "
         "strongest cut that removes nothing visible. Where the cut saves more than the weather costs, "
         "the far plane is moved out until both match.\n%1")
          .arg(stage_.conditions),
      this);
  intro->setWordWrap(true);

  steps_->setAccessibleName(tr("Weather steps to measure"));
  for (int i = int(WeatherStep::rain_light); i <= int(WeatherStep::snow_heavy); ++i) {
    auto* item = new QListWidgetItem(stepLabel(static_cast<WeatherStep>(i)), steps_);
    item->setFlags(Qt::ItemIsEnabled | Qt::ItemIsUserCheckable | Qt::ItemIsSelectable);
    item->setCheckState(Qt::Checked);
    item->setData(Qt::UserRole, i);
  }
  steps_->setMaximumWidth(170);
  frames_->setRange(1, 99);
  frames_->setValue(5);
  frames_->setSuffix(tr(" frames"));
  frames_->setToolTip(tr("Frames per measurement; their median counts. Choose more if other programs run"));
  auto* framesLabel = new QLabel(tr("Media&n of"), this);
  framesLabel->setBuddy(frames_);

  table_->setHorizontalHeaderLabels({tr("Weather"), tr("Outcome"), tr("Loss\n(ms)"), tr("Loss\n(fps)"),
                                     tr("Largest\ngain (ms)"), tr("Far plane\n(m)"), tr("Ratio"),
                                     tr("Density"), tr("Matched\n(ms)"),
                                     tr("Clear, weather,\nmatched (fps)")});
  table_->setAccessibleName(tr("Losses and gains"));
  table_->setEditTriggers(QAbstractItemView::NoEditTriggers);
  table_->setSelectionBehavior(QAbstractItemView::SelectRows);
  table_->setAlternatingRowColors(true);
  table_->setWordWrap(true);
  table_->verticalHeader()->hide();
  table_->setColumnWidth(kOutcome, 240);
  plot_->setMinimumHeight(kPlotHeight);
  status_->setWordWrap(true);
  rejected_->setWordWrap(true);
  rejected_->setAccessibleName(tr("What is not written, and why"));

  auto* left = new QVBoxLayout;
  left->addWidget(steps_, 1);
  auto* framesRow = new QHBoxLayout;
  framesRow->addWidget(framesLabel);
  framesRow->addWidget(frames_);
  left->addLayout(framesRow);
  left->addWidget(run_);
  auto* tabs = new QTabWidget(this);
  tabs->addTab(table_, tr("&Table"));
  tabs->addTab(plot_, tr("&Plot"));
  auto* middle = new QHBoxLayout;
  middle->addLayout(left);
  middle->addWidget(tabs, 1);
  auto* foot = new QHBoxLayout;
  foot->addWidget(status_, 1);
  foot->addWidget(rejected_, 1);
  foot->addWidget(write_);
  foot->addWidget(close_);
  auto* column = new QVBoxLayout(this);
  column->addWidget(intro);
  column->addLayout(middle, 1);
  column->addWidget(progress_);
  column->addLayout(foot);
  resize(1180, 560);

  run_->setDefault(true);
  write_->setAutoDefault(false);
  close_->setAutoDefault(false);
  write_->setToolTip(
      tr("Writes the far planes, and densities where the cut is not enough, as one step that can be undone"));
  connect(run_, &QPushButton::clicked, this, [this] { running_ ? cancel() : start(); });
  connect(write_, &QPushButton::clicked, this, &WeatherWizard::write);
  connect(close_, &QPushButton::clicked, this, &WeatherWizard::reject);
  setRunning(false);
}

void WeatherWizard::setRunning(bool running) {
  running_ = running;
  run_->setText(running ? tr("&Cancel") : tr("&Measure"));
  showWhatIsRejected();
  steps_->setEnabled(!running);
  frames_->setEnabled(!running);
  progress_->setVisible(running);
  emit measuringChanged(running);
}

std::vector<WeatherStep> WeatherWizard::chosenSteps() const {
  std::vector<WeatherStep> chosen;
  for (int i = 0; i < steps_->count(); ++i)
    if (const QListWidgetItem* item = steps_->item(i); item->checkState() == Qt::Checked)
      chosen.push_back(static_cast<WeatherStep>(item->data(Qt::UserRole).toInt()));
  return chosen;
}

std::optional<WeatherStage::Frame> WeatherWizard::drawn(const WeatherDecision& decision) {
  QCoreApplication::processEvents();
  if (cancelled_) return std::nullopt;
  const std::optional<WeatherStage::Frame> frame = stage_.draw(decision);
  if (!frame) failed_ = true;
  return frame;
}

std::optional<double> WeatherWizard::measure(const WeatherDecision& decision) {
  if (!last_ || *last_ != decision) {
    std::optional<std::uint64_t> built;
    for (int i = 0; i < kMostWarmUp; ++i) {
      const auto frame = drawn(decision);
      if (!frame) return std::nullopt;
      if (built == frame->tilesBuilt) break;
      built = frame->tilesBuilt;
    }
    last_ = decision;
    progress_->setValue(std::min(++measured_, progress_->maximum()));
  }
  const auto frame = drawn(decision);
  if (!frame) return std::nullopt;
  const QString where = std::isfinite(decision.farM)
                            ? tr("far plane %1 m").arg(views::numberText(decision.farM, 0))
                            : tr("no cut");
  status_->setText(
      tr("%1, density %2: %3 ms").arg(where, views::numberText(decision.density, 3), ms(frame->ms)));
  return frame->ms;
}

void WeatherWizard::start() {
  if (running_) return;
  const std::vector<WeatherStep> chosen = chosenSteps();
  results_.clear();
  table_->setRowCount(0);
  plot_->clear();
  cancelled_ = failed_ = false;
  last_.reset();
  measured_ = 0;
  progress_->setRange(0, std::max(int(chosen.size()) * kMostDecisions, 1));
  progress_->setValue(0);
  setRunning(true);

  const TuningParameters parameters = *draft_.active();
  CalibrationSettings settings;
  settings.tolerance = parameters.weather.tolerance.value();
  settings.farthestM = stage_.farthestM;
  settings.repeats = frames_->value();
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    measured_ = int(i) * kMostDecisions;
    const auto result = calibrateStep(
        chosen[i], parameters, [this](const WeatherDecision& d) { return measure(d); }, settings);
    if (!result) break;
    results_.push_back(*result);
    addRow(*result);
  }
  showPlot();
  setRunning(false);
  if (failed_)
    status_->setText(tr("Nothing can be drawn any more: only the steps above are measured."));
  else if (cancelled_)
    status_->setText(tr("Cancelled: %1 of %2 steps are measured.").arg(results_.size()).arg(chosen.size()));
  else
    status_->setText(chosen.empty() ? tr("No step is chosen.")
                                    : tr("Done. The preset is unchanged until you write."));
  if (closing_) QDialog::reject();
}

void WeatherWizard::addRow(const StepCalibration& c) {
  const int row = table_->rowCount();
  table_->insertRow(row);
  const auto put = [&](Column column, const QString& text) {
    auto* item = new QTableWidgetItem(text);
    if (column > kOutcome) item->setTextAlignment(Qt::AlignRight | Qt::AlignVCenter);
    if (column == kOutcome) item->setToolTip(text);
    table_->setItem(row, column, item);
  };
  put(kStep, stepLabel(c.step));
  put(kOutcome, outcomeText(c));
  put(kLoss, ms(c.lossMs()));
  put(kLossFps, views::numberText(1000 / c.clearMs - 1000 / c.uncutMs, 1));
  put(kGain, ms(c.strongestGainMs()));
  put(kFar, views::numberText(c.farM, 0));
  put(kRatio, QString::number(c.nearFarRatio, 'g', 3));
  put(kDensity, views::numberText(c.density, 3));
  put(kMatched, ms(c.matchedMs));
  put(kMatchedFps, QStringLiteral("%1 → %2 → %3").arg(fps(c.clearMs), fps(c.uncutMs), fps(c.matchedMs)));
  table_->resizeRowsToContents();
  for (int column = kLoss; column < kColumns; ++column) table_->resizeColumnToContents(column);
}

void WeatherWizard::showPlot() {
  if (results_.empty()) return plot_->clear();
  views::ReportPlotData bars{
      tr("What each weather step costs and what the cut wins back"), {}, tr("Frame time (ms)"), {}, {}};
  views::ReportPlotData::Series clear{tr("clear"), {}, {}}, uncut{tr("weather, no cut"), {}, {}},
      strongest{tr("cut at the visibility"), {}, {}}, matched{tr("as written"), {}, {}};
  for (const StepCalibration& c : results_) {
    bars.categories << stepLabel(c.step);
    clear.y << c.clearMs;
    uncut.y << c.uncutMs;
    strongest.y << c.strongestMs;
    matched.y << c.matchedMs;
  }
  bars.series << clear << uncut << strongest << matched;
  plot_->show(bars);
}

/// The button is there only if it writes something; why it is not stands in its place.
void WeatherWizard::showWhatIsRejected() {
  QStringList why;
  for (const StepCalibration& result : results_)
    if (const std::string each = whyRejected(result); !each.empty())
      why << tr("%1: %2").arg(stepLabel(result.step), QString::fromStdString(each));
  const bool any = results_.empty() || why.size() < qsizetype(results_.size());
  write_->setVisible(any);
  write_->setEnabled(!running_ && any && !results_.empty());
  rejected_->setVisible(!running_ && !why.isEmpty());
  rejected_->setText((any ? tr("Not written with the others:") : tr("Nothing can be written:")) +
                     QLatin1Char('\n') + why.join(QLatin1Char('\n')));
}

void WeatherWizard::write() {
  if (!write_->isEnabled()) return;
  TuningParameters parameters = draft_.parameters();
  applyAccepted(results_, parameters);
  draft_.takeParameters(parameters, tr("Calibrate Weather"));
  status_->setText(tr("Written as one step, which Edit > Undo reverts."));
}

void WeatherWizard::reject() {
  if (!running_) return QDialog::reject();
  closing_ = true;
  cancel();
}

}  // namespace trimtab::workbench
