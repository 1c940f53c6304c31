// SPDX-License-Identifier: GPL-3.0-or-later
#include "budget_panel.h"

#include <QBoxLayout>
#include <QComboBox>
#include <QHeaderView>
#include <QLabel>
#include <QPushButton>
#include <QTableWidget>
#include <algorithm>
#include <cmath>

#include "trimtab/measure/paired_ratio.h"
#include "views/controls/fold.h"
#include "views/controls/lever_chain_table.h"
#include "views/controls/parameter_lines.h"
#include "views/model/error_run.h"
#include "views/model/keys.h"
#include "views/model/theme.h"
#include "views/plots/budget_plot.h"

namespace trimtab::views {
namespace {

/// What everybody sets, and what is for who tunes the arbiter itself.
constexpr const char* kSwitchKeys[] = {"hold.enabled", "measure.budget_ms"};
constexpr const char* kLimitKeys[] = {"hold.error_maximum_px", "hold.render_scale_minimum",
                                      "hold.particles_minimum", "hold.blur_minimum"};
constexpr const char* kExpertKeys[] = {
    "hold.margin",     "hold.caution",           "hold.calm_ms",        "hold.look_ahead_frames",
    "hold.loss_error", "hold.loss_render_scale", "hold.loss_particles", "hold.loss_blur"};

QString percent(double share) {
  return std::isfinite(share) ? BudgetPanel::tr("%1 %").arg(numberText(100 * share, 1))
                              : BudgetPanel::tr("unknown");
}

/// What a recorded run can be flown again under: as the preset is, or in a mode of `trimtab-cli experiment
/// hold`. What is unset stays as the preset has it.
struct ReplayMode {
  const char* name;
  std::optional<bool> policy, hold;
  std::optional<MotionControl> headMotion;
  std::optional<RatioMode> weatherCut;
};
constexpr ReplayMode kReplayModes[] = {
    {QT_TRANSLATE_NOOP("BudgetPanel", "as the preset is now"), {}, {}, {}, {}},
    {QT_TRANSLATE_NOOP("BudgetPanel", "with nothing switched on"), false, false, MotionControl::off,
     RatioMode::off},
    {QT_TRANSLATE_NOOP("BudgetPanel", "as published (C and D)"), false, false,
     MotionControl::with_restoration, RatioMode::adaptive},
    {QT_TRANSLATE_NOOP("BudgetPanel", "with the policy alone"), true, false, MotionControl::off,
     RatioMode::adaptive},
    {QT_TRANSLATE_NOOP("BudgetPanel", "with the budget held"), std::nullopt, true, MotionControl::off,
     RatioMode::adaptive}};

/// Returns what the budget won and lost by a lever; null if it leaves the lever alone, or moves it with
/// another one, as the error of objects with that of the ground.
const LeverGain* gainOf(const HoldGains& gains, const FrameLeverRow& row) {
  if (row.value == &FrameLevers::errorPx) return &gains.error;
  if (row.value == &FrameLevers::renderScale) return &gains.renderScale;
  if (row.value == &FrameLevers::particleShare) return &gains.particles;
  if (row.value == &FrameLevers::blurStrength) return &gains.blur;
  return nullptr;
}
enum LeverColumn { kAsked, kBy, kDrawn, kWon, kLost, kLeverColumns };

/// Says what the lowered levers take off, as the end of a sentence: "render scale takes off 2.1 ms". Empty if
/// none is lowered.
QString wonText(const LeverChain& chain, const HoldGains& gains) {
  QStringList parts;
  for (const FrameLeverRow& row : kFrameLeverRows)
    if (const LeverGain* gain = gainOf(gains, row); gain && lastChange(chain, row) == LeverStep::budget)
      parts << BudgetPanel::tr("%1 takes off %2 ms")
                   .arg(fromView(row.label).toLower(), numberText(gain->ms, 1));
  return parts.join(QStringLiteral(", "));
}

QString inWords(const RecordedRun& run) {
  return BudgetPanel::tr("%1 s, median %2 ms, p99 %3 ms")
      .arg(numberText(run.durationS(), 1), numberText(quantileOf(run.ms(), 0.5), 1),
           numberText(quantileOf(run.ms(), 0.99), 1));
}

/// What the run that was flown again took, second by second of the flight.
QString comparedText(const RecordedRun& recorded, const RecordedRun& replayed) {
  const double beginS = recorded.states().front().time;
  const PairedRatio ratio = pairedRatio(recorded.mediansBySecond(beginS), replayed.mediansBySecond(beginS));
  if (differenceOf(ratio) == MeasuredDifference::unknown) return BudgetPanel::tr("too short to compare");
  return BudgetPanel::tr("%1 (× %2 to %3, by second)")
      .arg(QString::fromStdString(trimtab::inWords(ratio)), numberText(ratio.low, 2),
           numberText(ratio.high, 2));
}

}  // namespace

BudgetPanel::BudgetPanel(Draft& draft, QWidget* parent)
    : QWidget(parent),
      draft_(draft),
      state_(new QLabel(tr("The budget is not held"))),
      limit_(new QLabel),
      residuals_(new QLabel),
      comparison_(new QLabel),
      busy_(new QLabel),
      plot_(new BudgetPlot),
      replay_(new QPushButton(tr("Fl&y again"))),
      levers_(new QTableWidget(int(kFrameLeverRows.size()), kLeverColumns)),
      reasons_(new ReasonList),
      mode_(new QComboBox),
      throttle_(this, [this] { refresh(); }) {
  QFont bold = font();
  bold.setBold(true);
  state_->setFont(bold);
  for (QLabel* label : {state_, limit_, residuals_, comparison_, busy_}) label->setWordWrap(true);
  comparison_->setToolTip(tr(
      "A p99 needs 100 images. Runs are compared by the medians of each second, with the interval that holds "
      "the ratio by 95 %. They were flown one after the other, so that what the machine did in between is "
      "part of what differs; Measure and Compare draw in turns"));
  busy_->hide();
  residuals_->setToolTip(
      tr("Predictions made three images ahead, of the last 300 images: the median error of triangles and of "
         "time, and the share of images within the 90 % band."));
  levers_->setAccessibleName(tr("Levers of the budget"));
  levers_->setHorizontalHeaderLabels(
      {tr("Asked for"), tr("By"), tr("Drawn"), tr("Takes off (ms)"), tr("Loses (FLIP)")});
  levers_->horizontalHeaderItem(kBy)->setToolTip(
      tr("Who changed the lever last before the budget: preset, head motion, weather or policy. The tip of a "
         "row has the whole chain."));
  levers_->horizontalHeaderItem(kWon)->setToolTip(
      tr("What the lever takes off the predicted time. The levers of an image add up to the difference "
         "between what is asked for and what is held."));
  levers_->horizontalHeaderItem(kLost)->setToolTip(
      tr("What the image loses by the lever, as the mean FLIP that the preset's hold.loss_ parameters rate. "
         "Of all settings that fit the budget, the arbiter chooses the one that loses least."));
  QStringList names;
  for (const FrameLeverRow& row : kFrameLeverRows) names << fromView(row.label);
  levers_->setVerticalHeaderLabels(names);
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
  levers_->setFixedHeight(rowHeight * int(kFrameLeverRows.size() + 1) + 6);
  levers_->setVerticalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  reasons_->setAccessibleName(tr("Changes by the budget"));

  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(6, 6, 6, 6);
  layout->addWidget(new ParameterLines(draft, kSwitchKeys));
  layout->addWidget(limit_);
  layout->addWidget(state_);
  layout->addWidget(plot_);
  layout->addWidget(levers_);
  layout->addLayout(makeRecorder());
  layout->addWidget(residuals_);
  layout->addWidget(new QLabel(tr("<b>Changes</b>")));
  layout->addWidget(reasons_);
  layout->addWidget(new Fold(tr("How far it may go"), new ParameterLines(draft, kLimitKeys), true));
  layout->addWidget(new Fold(tr("Numbers for experts"), new ParameterLines(draft, kExpertKeys)));
  connect(&draft_, &Draft::activeChanged, this, [this] { throttle_.request(); });
  connect(&draft_, &Draft::imageGeneratorChanged, this, &BudgetPanel::refreshLevers);
  refresh();
}

QLayout* BudgetPanel::makeRecorder() {
  replay_->setToolTip(
      tr("Flies what was recorded last (File > Record trace) again, with line of sight and weather and with "
         "the preset as it is now, at most its first %1 s, and lays the recorded times over the new")
          .arg(RecordedRun::kLongestS));
  connect(replay_, &QPushButton::clicked, this, &BudgetPanel::askReplay);
  mode_->setAccessibleName(tr("Fly again"));
  mode_->setToolTip(tr("What is switched on or off before the run is flown again; Undo takes it back"));
  mode_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  mode_->setMinimumContentsLength(16);
  for (const ReplayMode& mode : kReplayModes) mode_->addItem(tr(mode.name));
  auto* row = new QHBoxLayout;
  row->addWidget(replay_);
  row->addWidget(mode_, 1);
  auto* column = new QVBoxLayout;
  column->addLayout(row);
  column->addWidget(comparison_);
  column->addWidget(busy_);
  return column;
}

void BudgetPanel::switchTo(int mode) {
  const ReplayMode& wanted = kReplayModes[std::clamp(mode, 0, int(std::size(kReplayModes)) - 1)];
  std::vector<Draft::KeyValue> values;
  const auto add = [&](std::string_view key, const ParameterValue& value) {
    if (draft_.value(key) != value) values.push_back({key, value});
  };
  if (wanted.policy) add(key::kPolicyEnabled, *wanted.policy);
  if (wanted.hold) add("hold.enabled", *wanted.hold);
  if (wanted.headMotion) add("motion.control", ChoiceIndex{std::size_t(*wanted.headMotion)});
  if (wanted.weatherCut) add("weather.ratio_mode", ChoiceIndex{std::size_t(*wanted.weatherCut)});
  if (!values.empty()) draft_.setValues(values, tr("Fly Again %1").arg(tr(wanted.name)));
}

void BudgetPanel::setRecording(bool on) {
  recording_ = on;
  if (on) recorded_ = {}, replayed_ = {}, stage_ = Replay::none, watch_ = {};
  refresh();
}

void BudgetPanel::askReplay() {
  setRecording(false);
  replayed_ = {};
  stage_ = Replay::asked;
  switchTo(mode_->currentIndex());
  emit replayAsked(recorded_.states());
}

void BudgetPanel::addToRun(const LiveFrame& frame) {
  if (recording_) {
    if (!recorded_.add(frame)) setRecording(false);
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

QString BudgetPanel::limitText() const {
  return limit_->text();
}

QString BudgetPanel::residualsText() const {
  return residuals_->text();
}

void BudgetPanel::showFrame(const LiveFrame& frame) {
  if (!frame.newImage) return;
  shown_ = frame.hold;
  chain_ = frame.levers;
  gains_ = frame.holdGains;
  throttle_.request();
  if (!frame.counts) return;
  plot_->append(frame, draft_.active()->measure.budget.value());
  if (shown_.reason != HoldReason::off && frame.holdOutcome) count(*frame.holdOutcome);
  addToRun(frame);
  note(frame);
}

void BudgetPanel::count(const HoldOutcome& o) {
  if (o.triangles > 0) trianglesOff_.add(std::abs(o.predictedTriangles / o.triangles - 1));
  if (o.ms > 0) timeOff_.add(std::abs(o.predictedMs / o.ms - 1));
  within_.add(std::abs(o.predictedMs - o.ms) <= o.halfBandMs);
}

void BudgetPanel::note(const LiveFrame& frame) {
  const HoldReason reason = shown_.reason;
  const bool moves = reason == HoldReason::lowered || reason == HoldReason::restored;
  // Levers that come back step by step are one change.
  if (reason == noted_ && reason != HoldReason::lowered) return;
  noted_ = reason;
  if (!moves && reason != HoldReason::out_of_reach && reason != HoldReason::fits &&
      reason != HoldReason::not_trusted)
    return;
  std::string text = explain(shown_);
  if (const QString won = frame.levers ? wonText(*frame.levers, frame.holdGains) : QString(); !won.isEmpty())
    text += "; " + won.toStdString();
  reasons_->add(frame.time, text);
}

void BudgetPanel::compare() {
  const std::size_t images = recorded_.images() + replayed_.images();
  if (images == comparedImages_ && !comparison_->text().isEmpty()) return;
  comparedImages_ = images;
  replay_->setEnabled(recorded_.images() > 1);
  QString text = recorded_.images() == 0 ? tr("Nothing is recorded yet: File > Record trace")
                                         : tr("Recorded: %1").arg(inWords(recorded_));
  if (replayed_.images() > 0)
    text += QLatin1Char('\n') +
            tr("Flown again: %1; %2").arg(inWords(replayed_), comparedText(recorded_, replayed_));
  comparison_->setText(text);
  busy_->setText(images > 0 ? QString::fromStdString(busyText(watch_.othersShare())) : QString());
  busy_->setVisible(!busy_->text().isEmpty());
}

void BudgetPanel::refreshLevers() {
  if (!chain_) return;
  for (std::size_t i = 0; i < kFrameLeverRows.size(); ++i) {
    const FrameLeverRow& row = kFrameLeverRows[i];
    const LeverGain* const gain = gainOf(gains_, row);
    const bool lowered = lastChange(*chain_, row) == LeverStep::budget;
    LeverChain asked = *chain_;
    asked.drawn = asked.policy;
    const QString texts[kLeverColumns] = {QString::fromStdString(valueText(chain_->policy, row)),
                                          fromView(toText(lastChange(asked, row))),
                                          QString::fromStdString(valueText(chain_->drawn, row)),
                                          lowered && gain ? numberText(gain->ms, 2) : QString(),
                                          lowered && gain ? numberText(gain->loss, 4) : QString()};
    QFont text = font();
    text.setBold(lowered);
    for (int column = 0; column < kLeverColumns; ++column) {
      QTableWidgetItem& item = *levers_->item(int(i), column);
      item.setText(texts[column]);
      item.setFont(text);
      item.setToolTip(QString::fromStdString(explain(*chain_, row)));
    }
  }
  showWhatIgHas(*levers_, *chain_, draft_.imageGenerator());
}

/// The smaller of two limits counts, so what caution takes beyond the margin is what is left.
void BudgetPanel::refreshLimit() {
  const TuningParameters& p = *draft_.active();
  const double budgetMs = p.measure.budget.value(), marginMs = budgetMs * p.hold.margin.value();
  if (!p.hold.enabled || !(shown_.limitMs > 0)) {
    limit_->setText(tr("%1 budget − %2 margin = %3 for predictions, less where they are unsure")
                        .arg(msText(budgetMs), msText(marginMs), msText(budgetMs - marginMs)));
    return;
  }
  const double cautionMs = std::max(budgetMs - marginMs - shown_.limitMs, 0.0);
  limit_->setText(tr("%1 budget − %2 margin − %3 caution = %4 for predictions")
                      .arg(msText(budgetMs), msText(marginMs), msText(cautionMs), msText(shown_.limitMs)));
}

void BudgetPanel::refresh() {
  const HoldDecision& d = shown_;
  if (d.reason == HoldReason::off) {
    state_->setText(tr("The budget is not held"));
  } else {
    QString text = QString::fromStdString(explain(d));
    text[0] = text[0].toUpper();
    state_->setText(text);
  }
  refreshLimit();
  refreshLevers();
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
