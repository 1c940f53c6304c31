// SPDX-License-Identifier: GPL-3.0-or-later
#include "plots_panel.h"

#include <QAction>
#include <QActionGroup>
#include <QBoxLayout>
#include <QComboBox>
#include <QFileDialog>
#include <QLabel>
#include <QMenu>
#include <QScrollArea>
#include <QSettings>
#include <QSplitter>
#include <QTabWidget>
#include <QToolButton>
#include <cmath>

#include "decision_log.h"
#include "frame_page.h"
#include "plot_values.h"
#include "signals_page.h"
#include "views/controls/ask_csv_file.h"
#include "views/controls/scrollable.h"
#include "views/controls/tell_findings.h"
#include "views/model/theme.h"
#include "views/plots/plot_picture.h"
#include "views/plots/time_plot.h"

namespace trimtab::views {

namespace {
// Drawing four lanes takes some ten milliseconds. A dozen times a second looks live and leaves the processor
// to the renderer. Statistics sort the frames that are shown.
constexpr int kRefreshMs = 80, kSideMs = 500;
constexpr int kWidePx = 620;
constexpr double kChangeReachPx = 5;
const QString kSpanKey = QStringLiteral("plots/span_s"), kLanesKey = QStringLiteral("plots/lanes"),
              kRobustKey = QStringLiteral("plots/robust"), kFramesKey = QStringLiteral("plots/frames");

/// Scrolls lanes that have no room, and arranges them again when its size changes.
class PlotArea : public QScrollArea {
 public:
  explicit PlotArea(TimePlot* plot) : plot_(plot) {
    setFrameShape(NoFrame);
    setWidgetResizable(true);
    setFocusPolicy(Qt::NoFocus);
    setWidget(plot);
  }

 protected:
  void resizeEvent(QResizeEvent* event) override {
    QScrollArea::resizeEvent(event);
    plot_->arrange();
  }

 private:
  TimePlot* plot_;
};

}  // namespace

PlotsPanel::PlotsPanel(Draft& draft, QWidget* parent)
    : QWidget(parent),
      draft_(draft),
      plot_(new TimePlot(buffer_, &marks_, standardLanes())),
      values_(new PlotValues(buffer_, *plot_)),
      framePage_(new FramePage(buffer_)),
      signals_(new SignalsPage),
      side_(new QTabWidget),
      parts_(new QSplitter(Qt::Horizontal)),
      tracked_(new QLabel),
      span_(new QComboBox),
      throttle_(
          this, [this] { refresh(); }, kRefreshMs),
      sideThrottle_(
          side_, [this] { refreshSide(); }, kSideMs) {
  makeActions();
  for (const auto& [seconds, text] : {std::pair{10, tr("10 s")},
                                      {30, tr("30 s")},
                                      {60, tr("1 min")},
                                      {300, tr("5 min")},
                                      {600, tr("10 min")},
                                      {3600, tr("1 h")}})
    span_->addItem(text, seconds);
  span_->setCurrentIndex(2);
  span_->setAccessibleName(tr("Time shown"));
  span_->setToolTip(tr("How much time the plots show; Ctrl and the wheel zoom"));
  connect(span_, &QComboBox::activated, this, [this] { plot_->setSpan(span_->currentData().toDouble()); });

  auto* bar = new QHBoxLayout;
  for (QAction* action : {pause_, follow_, cursors_, details_}) {
    auto* button = new QToolButton;
    button->setDefaultAction(action);
    button->setFocusPolicy(Qt::StrongFocus);
    bar->addWidget(button);
  }
  bar->insertWidget(2, span_);
  auto* more = new QToolButton;
  more->setText(tr("More"));
  more->setPopupMode(QToolButton::InstantPopup);
  more->setFocusPolicy(Qt::StrongFocus);
  more->setMenu(makeMore());
  bar->addWidget(more);
  bar->addWidget(tracked_, 1);
  tracked_->setTextFormat(Qt::PlainText);
  tracked_->setMinimumWidth(10);
  tracked_->setText(QStringLiteral(" "));

  parts_->addWidget(new PlotArea(plot_));
  parts_->addWidget(makeSide());
  parts_->setStretchFactor(0, 3);
  parts_->setStretchFactor(1, 2);
  parts_->setChildrenCollapsible(false);
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(4, 4, 4, 4);
  layout->addLayout(bar);
  layout->addWidget(parts_, 1);

  connect(plot_, &TimePlot::movedByHand, this, [this] { follow_->setChecked(false); });
  connect(plot_, &TimePlot::pauseAsked, pause_, &QAction::toggle);
  connect(plot_, &TimePlot::followAsked, this, [this] { setFollowing(true); });
  connect(plot_, &TimePlot::cursorsMoved, values_, &PlotValues::fillCursors);
  connect(plot_, &TimePlot::shownChanged, &sideThrottle_, &Throttle::request);
  connect(plot_, &TimePlot::tracked, this, &PlotsPanel::showTracked);
  connect(plot_, &TimePlot::frameClicked, this, &PlotsPanel::chooseFrame);
  connect(plot_, &TimePlot::spikeAsked, this, &PlotsPanel::chooseSpike);
  connect(signals_, &SignalsPage::added, plot_,
          [this](Trace trace) { plot_->addSignal(plot_->currentLane(), trace); });
  connect(framePage_, &FramePage::frameAsked, this, &PlotsPanel::chooseFrame);
  connect(framePage_, &FramePage::spikeAsked, this, &PlotsPanel::chooseSpike);
  const auto budget = [this] { plot_->setBudget(draft_.active()->measure.budget.value()); };
  connect(&draft_, &Draft::activeChanged, this, budget);
  budget();
}

QWidget* PlotsPanel::makeSide() {
  side_->addTab(values_, tr("Values"));
  framePlace_ = scrollable(framePage_, tr("Frame"));
  side_->addTab(framePlace_, tr("Frame"));
  side_->addTab(signals_, tr("Signals"));
  side_->setAccessibleName(tr("Details of the plots"));
  side_->setMinimumWidth(240);
  side_->hide();
  connect(side_, &QTabWidget::currentChanged, &sideThrottle_, &Throttle::request);
  return side_;
}

void PlotsPanel::makeActions() {
  const auto action = [this](const QString& text, const QString& tip) {
    auto* a = new QAction(text, this);
    a->setToolTip(tip);
    a->setCheckable(true);
    addAction(a);
    return a;
  };
  pause_ = action(tr("Pause"), tr("Hold the plots; recording goes on (Space)"));
  follow_ = action(tr("Follow"), tr("Keep the newest frame at the right edge (F)"));
  follow_->setChecked(true);
  cursors_ = action(tr("Cursors"), tr("Two cursors, and the difference between them"));
  details_ =
      action(tr("Details"), tr("Values over the shown range, one frame explained, and signals to add"));
  robust_ = action(tr("Robust range"), tr("A few frames far above all others do not flatten the rest"));
  robust_->setChecked(true);
  connect(pause_, &QAction::toggled, this, [this](bool paused) {
    plot_->hold(paused ? std::optional(buffer_.end()) : std::nullopt);
    if (!paused) throttle_.request();
  });
  connect(follow_, &QAction::toggled, this, [this](bool on) {
    if (on) pause_->setChecked(false);
    plot_->refresh(on);
  });
  connect(cursors_, &QAction::toggled, this, [this](bool on) {
    plot_->setCursors(on);
    if (!on) return;
    details_->setChecked(true);
    side_->setCurrentWidget(values_);
  });
  connect(details_, &QAction::toggled, this, [this](bool on) {
    side_->setVisible(on);
    if (on) refreshSide();
  });
  connect(robust_, &QAction::toggled, plot_, &TimePlot::setRobust);
}

QMenu* PlotsPanel::makeMore() {
  auto* menu = new QMenu(this);
  menu->setToolTipsVisible(true);
  menu->addAction(robust_);
  lengths_ = menu->addMenu(tr("Keep"));
  auto* group = new QActionGroup(this);
  for (const int frames : {30'000, 120'000, 240'000, 480'000}) {
    QAction* length =
        lengths_->addAction(tr("%L1 frames, %2 min at 60 a second").arg(frames).arg(frames / 3600));
    length->setCheckable(true);
    length->setData(frames);
    length->setChecked(std::size_t(frames) == TraceBuffer::kCapacity);
    group->addAction(length);
    connect(length, &QAction::triggered, this, [this, frames] { setBufferFrames(frames); });
  }
  menu->addAction(tr("Standard plots"), this, [this] { plot_->setLanes(standardLanes()); });
  menu->addSeparator();
  menu->addAction(tr("Save CSV…"), this, &PlotsPanel::askAndSave)
      ->setToolTip(tr("Save every frame of the shown range"));
  menu->addAction(tr("Save picture…"), this, &PlotsPanel::askAndSavePicture);
  menu->addSeparator();
  menu->addAction(tr("Clear"), this, &PlotsPanel::clear)->setToolTip(tr("Forget all recorded frames"));
  return menu;
}

void PlotsPanel::setBufferFrames(int frames) {
  for (QAction* length : lengths_->actions()) length->setChecked(length->data().toInt() == frames);
  buffer_.setCapacity(static_cast<std::size_t>(frames));
  throttle_.request();
}

void PlotsPanel::resizeEvent(QResizeEvent* event) {
  QWidget::resizeEvent(event);
  parts_->setOrientation(width() < kWidePx ? Qt::Vertical : Qt::Horizontal);
}

QListWidget& PlotsPanel::signalList() {
  return signals_->list();
}

QTableWidget& PlotsPanel::readout() {
  return *values_;
}

QString PlotsPanel::trackedText() const {
  return tracked_->toolTip();
}

void PlotsPanel::showFrame(const LiveFrame& frame) {
  if (!frame.counts) return;
  buffer_.append(frame);
  noteChange(frame);
  if (!isPaused()) throttle_.request();
}

void PlotsPanel::noteChange(const LiveFrame& frame) {
  if (lastDecision_ && isDecisionChange(*lastDecision_, frame.decision))
    marks_.addChange(buffer_.time(buffer_.end() - 1), changeText(*lastDecision_, frame.decision));
  lastDecision_ = frame.decision;
}

void PlotsPanel::mark(PlotMarks::Kind kind, bool on, double time) {
  marks_.set(kind, on, time);
  throttle_.request();
}

void PlotsPanel::refresh() {
  if (isPaused()) return;
  plot_->refresh(follow_->isChecked());
  if (side_->isVisible()) sideThrottle_.request();
}

void PlotsPanel::refreshSide() {
  if (side_->currentWidget() != values_) return;
  values_->fillCursors();
  values_->fillStatistics();
}

bool PlotsPanel::isPaused() const {
  return pause_->isChecked();
}
void PlotsPanel::setPaused(bool paused) {
  pause_->setChecked(paused);
}
void PlotsPanel::setFollowing(bool following) {
  follow_->setChecked(following);
}
void PlotsPanel::setSpan(double seconds) {
  int nearest = span_->currentIndex();
  const auto off = [&](int i) { return std::abs(std::log(span_->itemData(i).toDouble() / seconds)); };
  for (int i = 0; i < span_->count(); ++i)
    if (off(i) < off(nearest)) nearest = i;
  span_->setCurrentIndex(nearest);
  plot_->setSpan(span_->currentData().toDouble());
}

void PlotsPanel::setCursors(bool on) {
  cursors_->setChecked(on);
}

void PlotsPanel::clear() {
  buffer_.clear();
  marks_.clear();
  if (isPaused()) plot_->hold(0);
  plot_->choose({});
  plot_->refresh(follow_->isChecked());
  showFrameOf({});
  refreshSide();
}

void PlotsPanel::showFrameOf(std::optional<std::uint64_t> frame) {
  const auto [from, to] = plot_->framesShown();
  framePage_->show(frame, from, to, draft_.active()->measure.budget.value());
}

void PlotsPanel::chooseFrame(std::uint64_t frame) {
  if (frame < buffer_.begin() || frame >= buffer_.end()) return;
  const double time = buffer_.time(frame);
  if (!plot_->shown().contains(time)) {
    follow_->setChecked(false);
    plot_->setShown(time - plot_->span() / 2, time + plot_->span() / 2);
  }
  plot_->choose(time);
  side_->setCurrentWidget(framePlace_);
  details_->setChecked(true);
  showFrameOf(frame);
  emit frameChosen(buffer_.stateTime(frame));
}

void PlotsPanel::chooseSpike(int direction) {
  const auto [from, to] = plot_->framesShown();
  if (from == to) return;
  const std::uint64_t start = framePage_->frame().value_or(direction > 0 ? from : to);
  const double median = buffer_.statistics(Trace::frame_ms, from, to).median;
  if (const auto spike =
          nextSpike(buffer_, start, direction, plot_->end(), draft_.active()->measure.budget.value(), median))
    chooseFrame(*spike);
}

void PlotsPanel::showTracked(double time) {
  const auto say = [this](const QString& all) {
    tracked_->setText(tracked_->fontMetrics().elidedText(all, Qt::ElideRight, tracked_->width()));
    tracked_->setToolTip(all.trimmed());
  };
  if (std::isnan(time)) return say(QStringLiteral(" "));
  QStringList said;
  if (const auto frame = plot_->frameAt(time)) {
    said << tr("%1 s").arg(numberText(buffer_.time(*frame), 3));
    const double reach = kChangeReachPx * plot_->shown().size() / std::max(1, plot_->width());
    if (const PlotMarks::Change* change = marks_.changeNear(time, reach)) said << change->text;
    for (const TraceGraph* trace : plot_->traces()) {
      const PlotSignal& signal = trace->signal();
      said << QStringLiteral("%1 %2").arg(signal.name(),
                                          numberText(shownValue(buffer_, signal, *frame), signal.decimals));
    }
  } else {
    said << tr("%1 s").arg(numberText(time, 3)) << tr("no frame");
  }
  say(said.join(QStringLiteral(" · ")));
}

QString PlotsPanel::visibleRangeCsv() const {
  const QCPRange shown = plot_->shown();
  return QString::fromStdString(buffer_.csv(buffer_.atOrAfter(shown.lower), shown.upper, plot_->end()));
}

Findings PlotsPanel::saveCsv(const QString& file) const {
  return writeAtomically(file.toStdString(), visibleRangeCsv().toStdString()).findings();
}

Findings PlotsPanel::savePicture(const QString& file) const {
  return writePicture(*plot_, file);
}

void PlotsPanel::askAndSave() {
  const QString file = askCsvFile(this, tr("Save Shown Range"), QStringLiteral("frames.csv"));
  if (file.isEmpty()) return;
  tellFindings(this, tr("The frames were not saved"), tr("The frames were saved"), saveCsv(file));
}

void PlotsPanel::askAndSavePicture() {
  QFileDialog dialog(this, tr("Save Picture of the Plots"), {}, tr("PNG (*.png);;SVG (*.svg)"));
  dialog.setAcceptMode(QFileDialog::AcceptSave);
  dialog.setDefaultSuffix(QStringLiteral("png"));
  dialog.selectFile(QStringLiteral("plots.png"));
  connect(&dialog, &QFileDialog::filterSelected, &dialog, [&dialog](const QString& filter) {
    dialog.setDefaultSuffix(filter.startsWith(QLatin1String("SVG")) ? QStringLiteral("svg")
                                                                    : QStringLiteral("png"));
  });
  if (dialog.exec() != QDialog::Accepted) return;
  tellFindings(this, tr("The picture was not saved"), tr("The picture was saved"),
               savePicture(dialog.selectedFiles().constFirst()));
}

void PlotsPanel::keepIn(QSettings& settings) const {
  settings.setValue(kSpanKey, plot_->span());
  settings.setValue(kLanesKey, toText(plot_->lanes()));
  settings.setValue(kRobustKey, robust_->isChecked());
}

void PlotsPanel::readFrom(const QSettings& settings) {
  if (const auto lanes = lanesOf(settings.value(kLanesKey).toString())) plot_->setLanes(*lanes);
  robust_->setChecked(settings.value(kRobustKey, true).toBool());
  if (const double span = settings.value(kSpanKey).toDouble(); span > 0) setSpan(span);
}

void PlotsPanel::keepLengthIn(QSettings& settings) const {
  settings.setValue(kFramesKey, qulonglong(buffer_.capacity()));
}

void PlotsPanel::readLengthFrom(const QSettings& settings) {
  const int frames = settings.value(kFramesKey).toInt();
  for (const QAction* length : lengths_->actions())
    if (frames > 0 && std::abs(length->data().toInt() - frames) < int(TraceBuffer::kBlock))
      setBufferFrames(length->data().toInt());
}

}  // namespace trimtab::views
