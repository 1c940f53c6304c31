// SPDX-License-Identifier: GPL-3.0-or-later
#include "motion_panel.h"

#include <QBoxLayout>
#include <QComboBox>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <algorithm>

#include "trimtab/motion/head_motion.h"
#include "views/controls/bar_list.h"
#include "views/controls/parameter_lines.h"
#include "views/model/theme.h"
#include "views/plots/motion_plot.h"

namespace trimtab::views {
namespace {

/// The parameters that are worth having beside their effect; the Preset dock has all.
constexpr const char* kMotionKeys[] = {
    "motion.control",        "motion.frames",           "motion.dwell",         "motion.blur_frames",
    "motion.restore_frames", "motion.blur_duration_ms", "motion.blur_strength", "motion.blur_full_degps"};

QString stackText(const MotionStack& stack, double limit, bool ms, bool more) {
  const QString of = more ? MotionPanel::tr("> %1").arg(numberText(limit, 1)) : numberText(limit, 1);
  return ms ? MotionPanel::tr("%1 of %2 ms").arg(numberText(stack.ms, 0), of)
            : MotionPanel::tr("%1 of %2").arg(stack.frames).arg(of);
}

}  // namespace

MotionPanel::MotionPanel(Draft& draft, QWidget* parent)
    : QWidget(parent),
      draft_(draft),
      source_(new QComboBox),
      open_(new QPushButton(tr("&Open log…"))),
      columns_(new QPushButton(tr("Co&lumns…"))),
      name_(new QLabel),
      state_(new QLabel(tr("No frame has been decided yet"))),
      sweep_(new QLineEdit(QStringLiteral("180deg/1s/2s"))),
      bars_(new BarList),
      plot_(new MotionPlot),
      reasons_(new ReasonList),
      throttle_(this, [this] { refresh(); }) {
  source_->addItems({tr("as the host says"), tr("a recorded log"), tr("a sweep"),
                     tr("the pointer over the image"), tr("none: straight ahead")});
  source_->setAccessibleName(tr("Line of sight"));
  sweep_->setAccessibleName(tr("Sweep"));
  sweep_->setToolTip(
      tr("Degrees / seconds / wait: 180deg/1s/2s turns the head through 180 degrees in a second, waits two, "
         "and turns back. A nod: in front makes it up and down."));
  name_->setWordWrap(true);
  state_->setWordWrap(true);
  QFont bold = font();
  bold.setBold(true);
  state_->setFont(bold);
  bars_->setAccessibleName(tr("Stacks, LOD scale and blur"));
  reasons_->setAccessibleName(tr("Changes by head motion"));

  auto* top = new QHBoxLayout;
  top->addWidget(new QLabel(tr("Line of sight")));
  top->addWidget(source_, 1);
  top->addWidget(sweep_, 1);
  top->addWidget(open_);
  top->addWidget(columns_);
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(6, 6, 6, 6);
  layout->addLayout(top);
  layout->addWidget(name_);
  layout->addWidget(state_);
  layout->addWidget(bars_);
  layout->addWidget(plot_, 2);
  layout->addWidget(new QLabel(tr("<b>Changes</b>")));
  layout->addWidget(reasons_, 1);
  layout->addWidget(new ParameterLines(draft, kMotionKeys));

  connect(source_, &QComboBox::activated, this, [this](int source) {
    showWidgetsOf(static_cast<Source>(source));
    if (source == log)
      emit openLogAsked();
    else
      emit sourceAsked(source);
  });
  connect(open_, &QPushButton::clicked, this, &MotionPanel::openLogAsked);
  columns_->setToolTip(tr("Says which column of the log is which quantity, and in what unit"));
  connect(columns_, &QPushButton::clicked, this, &MotionPanel::columnsAsked);
  connect(sweep_, &QLineEdit::returnPressed, this, [this] { emit sourceAsked(sweep); });
  showWidgetsOf(host);
  refresh();
}

MotionPanel::Source MotionPanel::source() const {
  return static_cast<Source>(source_->currentIndex());
}

QString MotionPanel::sweepText() const {
  const QString text = sweep_->text().trimmed();
  return text.startsWith(QLatin1String("nod:")) || text.startsWith(QLatin1String("sweep:"))
             ? text
             : QStringLiteral("sweep:") + text;
}

QString MotionPanel::stateText() const {
  return state_->text();
}

void MotionPanel::setSource(Source source, const QString& name) {
  source_->setCurrentIndex(source);
  name_->setText(source == log ? name : QString());
  showWidgetsOf(source);
}

void MotionPanel::showWidgetsOf(Source source) {
  open_->setVisible(source == log);
  columns_->setVisible(source == log);
  sweep_->setVisible(source == sweep);
  name_->setVisible(source == log && !name_->text().isEmpty());
}

void MotionPanel::showFrame(const LiveFrame& frame) {
  any_ = true;
  if (frame.counts) plot_->append(frame);
  if (frame.decision.motion != motion_) {
    motion_ = frame.decision.motion;
    if (changesState(motion_.reason)) reasons_->add(frame.time, explain(motion_));
  }
  throttle_.request();
}

void MotionPanel::refresh() {
  const MotionDecision& m = motion_;
  if (any_) {
    if (m.reason == MotionReason::off)
      state_->setText(tr("Head motion is off"));
    else
      state_->setText(tr("%1: %2 deg/s, threshold %3 deg/s")
                          .arg(m.fast ? tr("Fast") : tr("Slow"), numberText(m.rateDegPerS, 1),
                               numberText(m.thresholdDegPerS, 1)));
  }
  const auto filled = [&m](const MotionStack& stack) { return m.limitsInMs ? stack.ms : stack.frames; };
  std::vector<BarList::Bar> bars;
  bars.push_back({.name = tr("BlurStack"),
                  .value = filled(m.blurStack),
                  .top = std::max(m.blurLimit, 1.0),
                  .text = stackText(m.blurStack, m.blurLimit, m.limitsInMs, false),
                  .ticks = {},
                  .colour = 5});
  // This stack acts above its limit, so the bar reaches one frame farther.
  bars.push_back({.name = tr("LODRestoreStack"),
                  .value = filled(m.restoreStack),
                  .top = m.restoreLimit + 1,
                  .text = stackText(m.restoreStack, m.restoreLimit, m.limitsInMs, true),
                  .ticks = {m.restoreLimit},
                  .colour = 2,
                  .quiet = m.restoreLimit <= 0});
  bars.push_back({.name = tr("LOD scale by head motion"),
                  .value = m.lodScale - 1,
                  .top = std::max(3.0, m.lodScale - 1),
                  .text = tr("× %1, level %2").arg(numberText(m.lodScale, 2)).arg(m.level),
                  .ticks = {},
                  .colour = 1});
  bars.push_back({.name = tr("Blur asked for"),
                  .value = m.blur.remainingMs,
                  .top = std::max(draft_.active()->motion.blurDuration.value(), m.blur.remainingMs),
                  .text = m.blur.strength > 0
                              ? tr("%1 ms left, strength %2")
                                    .arg(numberText(m.blur.remainingMs, 0), numberText(m.blur.strength, 2))
                              : tr("none"),
                  .ticks = {},
                  .colour = 4});
  bars_->setBars(std::move(bars));
  plot_->refresh();
}

}  // namespace trimtab::views
