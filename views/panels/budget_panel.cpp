// SPDX-License-Identifier: GPL-3.0-or-later
#include "budget_panel.h"

#include <QBoxLayout>
#include <QHeaderView>
#include <QLabel>
#include <QPushButton>
#include <QTableWidget>
#include <algorithm>
#include <cmath>

#include "views/controls/parameter_lines.h"
#include "views/model/theme.h"
#include "views/plots/budget_plot.h"

namespace trimtab::views {
namespace {

constexpr const char* kBudgetKeys[] = {
    "hold.enabled",          "measure.budget_ms",         "hold.margin",
    "hold.error_maximum_px", "hold.render_scale_minimum", "hold.particles_minimum",
    "hold.calm_ms"};

QString percent(double share) {
  return std::isfinite(share) ? BudgetPanel::tr("%1 %").arg(numberText(100 * share, 1))
                              : BudgetPanel::tr("unknown");
}

QString inWords(const RecordedRun& run) {
  SampleWindow times(std::max<std::size_t>(run.images(), 1));
  for (const double ms : run.ms()) times.add(ms);
  return BudgetPanel::tr("%1 s, median %2 ms, p99 %3 ms")
      .arg(numberText(run.durationS(), 1), numberText(times.median(), 1),
           numberText(times.quantile(0.99), 1));
}

}  // namespace

BudgetPanel::BudgetPanel(Draft& draft, QWidget* parent)
    : QWidget(parent),
      draft_(draft),
      state_(new QLabel(tr("The budget is not held: switch it on below"))),
      residuals_(new QLabel),
      comparison_(new QLabel),
      plot_(new BudgetPlot),
      record_(new QPushButton(tr("&Record"))),
      replay_(new QPushButton(tr("Fl&y again"))),
      levers_(new QTableWidget(4, 3)),
      reasons_(new ReasonList),
      throttle_(this, [this] { refresh(); }) {
  QFont bold = font();
  bold.setBold(true);
  state_->setFont(bold);
  for (QLabel* label : {state_, residuals_, comparison_}) label->setWordWrap(true);
  residuals_->setToolTip(
      tr("Predictions made three images ahead, of the last 300 images: the median error of triangles and of "
         "time, and the share of images within the 90 % band."));
  levers_->setAccessibleName(tr("Levers of the budget"));
  levers_->setHorizontalHeaderLabels({tr("Asked for"), tr("Held"), tr("Given")});
  levers_->setVerticalHeaderLabels(
      {tr("Allowed error (px)"), tr("Render scale"), tr("Particle density"), tr("Blur")});
  levers_->horizontalHeader()->setSectionResizeMode(QHeaderView::Stretch);
  levers_->setEditTriggers(QAbstractItemView::NoEditTriggers);
  levers_->setSelectionMode(QAbstractItemView::NoSelection);
  for (int row = 0; row < levers_->rowCount(); ++row)
    for (int column = 0; column < levers_->columnCount(); ++column) {
      auto* item = new QTableWidgetItem;
      item->setTextAlignment(Qt::AlignRight | Qt::AlignVCenter);
      levers_->setItem(row, column, item);
    }
  const int rowHeight = fontMetrics().height() + 6;
  levers_->verticalHeader()->setDefaultSectionSize(rowHeight);
  levers_->setFixedHeight(rowHeight * 5 + 6);
  levers_->setVerticalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  reasons_->setAccessibleName(tr("Changes by the budget"));

  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(6, 6, 6, 6);
  layout->addWidget(state_);
  layout->addWidget(plot_, 3);
  layout->addLayout(makeRecorder());
  layout->addWidget(residuals_);
  layout->addWidget(levers_);
  layout->addWidget(new QLabel(tr("<b>Changes</b>")));
  layout->addWidget(reasons_, 1);
  layout->addWidget(new ParameterLines(draft, kBudgetKeys));
  refresh();
}

QLayout* BudgetPanel::makeRecorder() {
  record_->setCheckable(true);
  record_->setToolTip(tr("Records what is flown, with line of sight and weather, for at most %1 s")
                          .arg(RecordedRun::kLongestS));
  replay_->setToolTip(
      tr("Flies what was recorded again, with the preset as it is now, and lays the recorded times over the "
         "new"));
  connect(record_, &QPushButton::toggled, this, &BudgetPanel::setRecording);
  connect(replay_, &QPushButton::clicked, this, &BudgetPanel::askReplay);
  auto* row = new QHBoxLayout;
  row->addWidget(record_);
  row->addWidget(replay_);
  row->addWidget(comparison_, 1);
  return row;
}

void BudgetPanel::setRecording(bool on) {
  if (on) recorded_ = {}, replayed_ = {}, stage_ = Replay::none;
  refresh();
}

void BudgetPanel::askReplay() {
  record_->setChecked(false);
  replayed_ = {};
  stage_ = Replay::asked;
  emit replayAsked(recorded_.states());
}

void BudgetPanel::addToRun(const LiveFrame& frame) {
  if (record_->isChecked()) {
    if (!recorded_.add(frame)) record_->setChecked(false);
    return;
  }
  if (stage_ == Replay::none) return;
  // Until the first recorded state is back, an image is still one of what was flown before.
  const double since = frame.input.state.time - recorded_.states().front().time;
  if (stage_ == Replay::asked && since >= 0 && since < recorded_.durationS()) {
    stage_ = Replay::flies;
    plot_->overlay(recorded_, frame.time - since);
  }
  if (stage_ != Replay::flies) return;
  replayed_.add(frame);
  if (since >= recorded_.durationS() || since < 0) stage_ = Replay::none;
}

QString BudgetPanel::comparisonText() const {
  return comparison_->text();
}

QString BudgetPanel::stateText() const {
  return state_->text();
}

QString BudgetPanel::residualsText() const {
  return residuals_->text();
}

void BudgetPanel::showFrame(const LiveFrame& frame) {
  if (!frame.newImage) return;
  shown_ = frame.hold;
  plot_->append(frame, draft_.active()->measure.budget.value());
  if (shown_.reason != HoldReason::off && frame.holdOutcome) count(*frame.holdOutcome);
  addToRun(frame);
  note(frame);
  throttle_.request();
}

void BudgetPanel::count(const HoldOutcome& o) {
  if (o.triangles > 0) trianglesOff_.add(std::abs(o.predictedTriangles / o.triangles - 1));
  if (o.ms > 0) timeOff_.add(std::abs(o.predictedMs / o.ms - 1));
  within_.add(std::abs(o.predictedMs - o.ms) <= o.bandMs);
}

void BudgetPanel::note(const LiveFrame& frame) {
  const HoldReason reason = shown_.reason;
  const bool moves = reason == HoldReason::lowered || reason == HoldReason::restored;
  // Levers that come back step by step are one change.
  if (reason == noted_ && reason != HoldReason::lowered) return;
  noted_ = reason;
  if (!moves && reason != HoldReason::out_of_reach && reason != HoldReason::fits) return;
  reasons_->add(frame.time, explain(shown_));
}

void BudgetPanel::compare() {
  const std::size_t images = recorded_.images() + replayed_.images();
  if (images == comparedImages_ && !comparison_->text().isEmpty()) return;
  comparedImages_ = images;
  replay_->setEnabled(recorded_.images() > 1);
  QString text =
      recorded_.images() == 0 ? tr("Nothing is recorded") : tr("Recorded: %1").arg(inWords(recorded_));
  if (replayed_.images() > 0) text += QLatin1Char('\n') + tr("Flown again: %1").arg(inWords(replayed_));
  comparison_->setText(text);
}

void BudgetPanel::refresh() {
  const HoldDecision& d = shown_;
  if (d.reason == HoldReason::off) {
    state_->setText(tr("The budget is not held: switch it on below"));
  } else {
    QString text = QString::fromStdString(explain(d));
    text[0] = text[0].toUpper();
    state_->setText(text);
  }
  const auto set = [&](int row, double asked, double held, int decimals) {
    levers_->item(row, 0)->setText(numberText(asked, decimals));
    levers_->item(row, 1)->setText(numberText(held, decimals));
    levers_->item(row, 2)->setText(asked == held ? tr("nothing")
                                                 : tr("× %1").arg(numberText(held / asked, 2)));
  };
  set(0, d.asked.errorPx, d.held.errorPx, 2);
  set(1, d.asked.renderScale, d.held.renderScale, 2);
  set(2, d.asked.particleShare, d.held.particleShare, 2);
  set(3, d.asked.blurShare, d.held.blurShare, 2);

  if (within_.size() == 0)
    residuals_->setText(tr("No prediction has come due yet"));
  else
    residuals_->setText(
        tr("Three images ahead: triangles off by %1, time by %2; %3 within the 90 % band")
            .arg(percent(trianglesOff_.median()), percent(timeOff_.median()), percent(within_.mean())));
  compare();
  plot_->refresh();
}

}  // namespace trimtab::views
