// SPDX-License-Identifier: GPL-3.0-or-later
#include "plots_panel.h"

#include <QAction>
#include <QBoxLayout>
#include <QComboBox>
#include <QHeaderView>
#include <QLabel>
#include <QMessageBox>
#include <QTableWidget>
#include <QToolButton>
#include <cmath>

#include "views/controls/ask_csv_file.h"
#include "views/model/theme.h"
#include "views/plots/time_plot.h"

namespace trimtab::views {

namespace {
// A picture of four lanes costs some ten milliseconds: a dozen a second look live and leave the core to the
// renderer.
constexpr int kRefreshMs = 80;
}  // namespace

PlotsPanel::PlotsPanel(Draft& draft, QWidget* parent)
    : QWidget(parent),
      draft_(draft),
      plot_(new TimePlot(buffer_)),
      readout_(new QTableWidget),
      tracked_(new QLabel),
      span_(new QComboBox),
      throttle_(
          this, [this] { refresh(); }, kRefreshMs) {
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
  span_->setToolTip(tr("How much time the plots show"));
  connect(span_, &QComboBox::activated, this, [this] { plot_->setSpan(span_->currentData().toDouble()); });

  QHBoxLayout* bar = new QHBoxLayout;
  for (QAction* action : actions()) {
    QToolButton* button = new QToolButton;
    button->setDefaultAction(action);
    button->setFocusPolicy(Qt::StrongFocus);
    bar->addWidget(button);
  }
  bar->insertWidget(2, span_);
  bar->addWidget(tracked_, 1);

  readout_->setAccessibleName(tr("Values at the cursors and their difference"));
  readout_->setColumnCount(4);
  readout_->setHorizontalHeaderLabels(
      {tr("Trace"), QStringLiteral("A"), QStringLiteral("B"), QStringLiteral("B − A")});
  readout_->verticalHeader()->hide();
  readout_->verticalHeader()->setDefaultSectionSize(fontMetrics().height() + 4);
  readout_->horizontalHeader()->setSectionResizeMode(QHeaderView::Stretch);
  readout_->setEditTriggers(QAbstractItemView::NoEditTriggers);
  readout_->setTabKeyNavigation(false);
  readout_->setRowCount(static_cast<int>(plot_->traces().size()) + 1);
  readout_->setSizeAdjustPolicy(QAbstractScrollArea::AdjustToContents);
  readout_->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Maximum);
  readout_->hide();
  tracked_->setTextFormat(Qt::PlainText);
  tracked_->setMinimumWidth(10);
  tracked_->setText(QStringLiteral(" "));

  QVBoxLayout* layout = new QVBoxLayout(this);
  layout->setContentsMargins(4, 4, 4, 4);
  layout->addLayout(bar);
  layout->addWidget(plot_, 1);
  layout->addWidget(readout_);

  connect(plot_, &TimePlot::movedByHand, this, [this] { follow_->setChecked(false); });
  connect(plot_, &TimePlot::pauseAsked, pause_, &QAction::toggle);
  connect(plot_, &TimePlot::followAsked, this, [this] { setFollowing(true); });
  connect(plot_, &TimePlot::cursorsMoved, this, &PlotsPanel::fillReadout);
  connect(plot_, &TimePlot::tracked, this, &PlotsPanel::showTracked);
  const auto budget = [this] { plot_->setBudget(draft_.active()->measure.budget.value()); };
  connect(&draft_, &Draft::activeChanged, this, budget);
  budget();
}

void PlotsPanel::makeActions() {
  const auto action = [this](const QString& text, const QString& tip, bool checkable) {
    QAction* a = new QAction(text, this);
    a->setToolTip(tip);
    a->setCheckable(checkable);
    addAction(a);
    return a;
  };
  pause_ = action(tr("Pause"), tr("Hold the picture; recording goes on (Space)"), true);
  follow_ = action(tr("Follow"), tr("Keep the newest frame at the right edge (F)"), true);
  follow_->setChecked(true);
  cursors_ = action(tr("Cursors"), tr("Two cursors, and the difference between them"), true);
  QAction* save = action(tr("Save CSV…"), tr("Save every frame of the shown range"), false);
  QAction* empty = action(tr("Clear"), tr("Forget all recorded frames"), false);
  connect(pause_, &QAction::toggled, this, [this](bool paused) {
    if (!paused) throttle_.request();
  });
  connect(follow_, &QAction::toggled, this, [this](bool on) {
    if (on) pause_->setChecked(false);
    plot_->refresh(on);
  });
  connect(cursors_, &QAction::toggled, this, [this](bool on) {
    plot_->setCursors(on);
    readout_->setVisible(on);
  });
  connect(save, &QAction::triggered, this, &PlotsPanel::askAndSave);
  connect(empty, &QAction::triggered, this, &PlotsPanel::clear);
}

void PlotsPanel::showFrame(const LiveFrame& frame) {
  buffer_.append(frame);
  if (!isPaused()) throttle_.request();
}

void PlotsPanel::refresh() {
  if (isPaused()) return;
  plot_->refresh(follow_->isChecked());
  if (plot_->hasCursors()) fillReadout();
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
  plot_->refresh(follow_->isChecked());
  fillReadout();
}

double PlotsPanel::valueAt(const TraceGraph& trace, std::uint64_t frame) const {
  Trace which = trace.look().trace;
  // The stacked lane draws upper edges; a person reads the stage itself.
  if (trace.look().filled)
    for (const StackedStage& stacked : kStack)
      if (stacked.top == trace.look().trace) which = stacked.stage;
  return static_cast<double>(buffer_.value(which, frame)) * trace.look().scale;
}

void PlotsPanel::fillReadout() {
  if (!plot_->hasCursors()) return;
  const auto cell = [this](int row, int column, const QString& text) {
    QTableWidgetItem* item = readout_->item(row, column);
    if (!item) readout_->setItem(row, column, item = new QTableWidgetItem);
    if (column > 0) item->setTextAlignment(Qt::AlignRight | Qt::AlignVCenter);
    item->setText(text);
  };
  const auto line = [&](int row, const QString& name, double a, double b, int decimals) {
    cell(row, 0, name);
    cell(row, 1, numberText(a, decimals));
    cell(row, 2, numberText(b, decimals));
    cell(row, 3, numberText(b - a, decimals));
  };
  if (buffer_.empty()) return line(0, tr("time (s)"), plot_->cursor(0), plot_->cursor(1), 3);
  const std::uint64_t a = buffer_.nearest(plot_->cursor(0)), b = buffer_.nearest(plot_->cursor(1));
  line(0, tr("time (s)"), buffer_.time(a), buffer_.time(b), 3);
  int row = 1;
  for (const TraceGraph* trace : plot_->traces()) {
    const double at = valueAt(*trace, a), bt = valueAt(*trace, b);
    readout_->setRowHidden(row, trace->look().rare && std::isnan(at) && std::isnan(bt));
    line(row++, trace->look().fullName(), at, bt, trace->look().decimals + 1);
  }
}

void PlotsPanel::showTracked(double time) {
  if (std::isnan(time) || buffer_.empty()) return tracked_->setText(QStringLiteral(" "));
  const std::uint64_t frame = buffer_.nearest(time);
  QStringList said{tr("%1 s").arg(numberText(buffer_.time(frame), 3))};
  for (const TraceGraph* trace : plot_->traces())
    said << QStringLiteral("%1 %2").arg(trace->look().name,
                                        numberText(valueAt(*trace, frame), trace->look().decimals));
  const QString all = said.join(QStringLiteral(" · "));
  tracked_->setText(tracked_->fontMetrics().elidedText(all, Qt::ElideRight, tracked_->width()));
  tracked_->setToolTip(all);
}

QString PlotsPanel::visibleRangeCsv() const {
  return QString::fromStdString(buffer_.csv(plot_->shown().lower, plot_->shown().upper));
}

Findings PlotsPanel::saveCsv(const QString& file) const {
  return writeAtomically(file.toStdString(), visibleRangeCsv().toStdString()).findings();
}

void PlotsPanel::askAndSave() {
  const QString file = askCsvFile(this, tr("Save Shown Range"), QStringLiteral("frames.csv"));
  if (file.isEmpty()) return;
  if (const Findings findings = saveCsv(file); !findings.empty())
    QMessageBox::warning(this, tr("The frames were not saved"), QString::fromStdString(toString(findings)));
}

}  // namespace trimtab::views
