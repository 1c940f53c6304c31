// SPDX-License-Identifier: GPL-3.0-or-later
#include <QContextMenuEvent>
#include <QMenu>
#include <QMimeData>
#include <algorithm>

#include "time_plot.h"
#include "time_plot_marks.h"
#include "views/model/theme.h"

/// TimePlot's lanes: what is in them, and how they are placed.
namespace trimtab::views {
namespace {

constexpr int kLanePx = 96, kTimeAxisPx = 34, kWidePx = 700;
constexpr int kLeastCurvePx = 44;
constexpr int kColours = 7;
constexpr std::array kShapes{QCPScatterStyle::ssCircle,  QCPScatterStyle::ssSquare,
                             QCPScatterStyle::ssDiamond, QCPScatterStyle::ssTriangle,
                             QCPScatterStyle::ssCross,   QCPScatterStyle::ssTriangleInverted,
                             QCPScatterStyle::ssPlus};
constexpr std::array kPens{Qt::SolidLine, Qt::DashLine, Qt::DotLine, Qt::DashDotLine};

}  // namespace

void TimePlot::setLanes(PlotLanes lanes) {
  if (lanes.empty()) lanes = standardLanes();
  const QCPRange before = shown();
  content_ = std::move(lanes);
  makeLanes();
  for (Lane& lane : lanes_) lane.rect->axis(QCPAxis::atBottom)->setRange(before);
  setBudget(budget_);
  restyle();
  emit lanesChanged();
}

bool TimePlot::shows(Trace trace) const {
  return std::ranges::any_of(
      content_, [&](const PlotLane& lane) { return std::ranges::count(lane.traces, trace) > 0; });
}

void TimePlot::addSignal(std::size_t lane, Trace trace) {
  if (lane >= content_.size() || std::ranges::count(content_[lane].traces, trace) > 0) return;
  PlotLanes lanes = content_;
  lanes[lane].traces.push_back(trace);
  setLanes(std::move(lanes));
}

void TimePlot::removeSignal(std::size_t lane, Trace trace) {
  if (lane >= content_.size()) return;
  PlotLanes lanes = content_;
  std::erase(lanes[lane].traces, trace);
  if (lanes[lane].traces.empty() && !lanes[lane].stages) return removeLane(lane);
  setLanes(std::move(lanes));
}

void TimePlot::addLane(PlotLane lane) {
  PlotLanes lanes = content_;
  lanes.push_back(std::move(lane));
  current_ = lanes.size() - 1;
  setLanes(std::move(lanes));
}

void TimePlot::removeLane(std::size_t lane) {
  if (lane >= content_.size() || content_.size() == 1) return;
  PlotLanes lanes = content_;
  lanes.erase(lanes.begin() + static_cast<std::ptrdiff_t>(lane));
  setLanes(std::move(lanes));
}

void TimePlot::makeLanes() {
  for (Lane& lane : lanes_) lane.legend->clearItems();
  traces_.clear();
  clearPlottables();
  clearItems();
  plotLayout()->clear();
  lanes_.clear();
  columns_ = 0;
  for (const PlotLane& content : content_) makeLane(content);
  current_ = std::min(current_, lanes_.size() - 1);
  std::vector<QCPAxisRect*> rects;
  for (Lane& lane : lanes_) {
    rects.push_back(lane.rect);
    if (marks_) new Marks(*this, *marks_, lane.rect, rects.size() == 1);
  }
  for (TimeCursor& cursor : cursor_) cursor.attach(*this, "cursors", rects);
  cursor_[0].setFlag(QStringLiteral("A"));
  cursor_[1].setFlag(QStringLiteral("B"));
  chosen_.attach(*this, "cursors", rects);
  chosen_.setFlag(tr("frame"));
  trackIn(rects);
  arrange();
}

void TimePlot::makeLane(const PlotLane& content) {
  Lane lane;
  lane.cell = new QCPLayoutGrid;
  plotLayout()->addElement(static_cast<int>(lanes_.size()), 0, lane.cell);
  lane.cell->setRowSpacing(0);
  lane.legend = makeLegend();
  lane.cell->addElement(0, 0, lane.legend);
  lane.cell->setRowStretchFactor(0, 0.001);
  lane.rect = new QCPAxisRect(this, true);
  lane.cell->addElement(1, 0, lane.rect);
  lane.rect->setMinimumMargins(QMargins(4, 3, 4, 2));
  lane.rect->setSizeConstraintRect(QCPLayoutElement::scrInnerRect);
  lane.rect->setMinimumSize(50, kLeastCurvePx);
  QCPAxis* time = lane.rect->axis(QCPAxis::atBottom);
  for (QCPAxis* axis : {lane.rect->axis(QCPAxis::atLeft), lane.rect->axis(QCPAxis::atRight)}) {
    axis->setSubTicks(false);
    axis->ticker()->setTickCount(3);
  }
  time->setSubTicks(false);
  time->ticker()->setTickCount(6);
  time->setNumberFormat(QStringLiteral("f"));
  lanes_.push_back(lane);
  Lane& made = lanes_.back();

  if (content.stages) addStages(made);
  // The unit of the first signal is on the left, any other on the right.
  const std::string_view left = content.stages           ? "ms"
                                : content.traces.empty() ? ""
                                                         : signalOf(content.traces.front()).unit;
  int at = 0;
  for (const Trace trace : content.traces) {
    const PlotSignal& signal = signalOf(trace);
    const bool right = left != signal.unit;
    TraceGraph::Look look{
        trace,
        signal.name(),
        QString::fromUtf8(signal.unit),
        at % kColours,
        kShapes[static_cast<std::size_t>(at) % kShapes.size()],
        right ? Qt::DashLine : kPens[static_cast<std::size_t>(at / kColours) % kPens.size()],
        signal.scale,
        signal.decimals,
        false,
        signal.rare};
    if (right) look.unit = look.unit.isEmpty() ? tr("right") : tr("%1, right").arg(look.unit);
    addTrace(made, std::move(look), right);
    ++at;
  }
  if (left == "ms") {
    made.budget = addLine("main", made.rect);
    putHorizontal(*made.budget, budget_);
  }
  addTextsOf(made);
}

void TimePlot::addTextsOf(Lane& lane) {
  const auto add = [&](Qt::Alignment place) {
    auto* text = new QCPItemText(this);
    text->setClipAxisRect(lane.rect);
    text->position->setAxes(lane.rect->axis(QCPAxis::atBottom), lane.rect->axis(QCPAxis::atLeft));
    text->position->setTypeX(QCPItemPosition::ptAxisRectRatio);
    text->position->setAxisRect(lane.rect);
    text->setPositionAlignment(place);
    return text;
  };
  if (lane.budget) lane.budgetText = add(Qt::AlignRight | Qt::AlignBottom);
  lane.longest = add(Qt::AlignRight | Qt::AlignTop);
  lane.longest->position->setTypeY(QCPItemPosition::ptAxisRectRatio);
  lane.longest->position->setCoords(0.995, 0);
}

void TimePlot::addStages(Lane& lane) {
  // The highest area comes first, and each next one is drawn over its lower part.
  constexpr int kStageColours[]{3, 6, 1, 2, 0};
  for (std::size_t i = kStack.size(); i-- > 0;) {
    const PlotSignal& signal = signalOf(kStack[i].stage);
    addTrace(lane,
             {kStack[i].top, signal.name(), QString::fromUtf8(signal.unit), kStageColours[i],
              QCPScatterStyle::ssNone, Qt::SolidLine, 1, signal.decimals, true},
             false);
  }
  // These run beside the stages, or are parts of one of them.
  constexpr int kColour[]{5, 4, 6, 2};
  std::size_t at = 0;
  for (const Trace trace : {Trace::gpu_ms, Trace::blur_ms, Trace::weather_ms, Trace::symbology_ms}) {
    const PlotSignal& signal = signalOf(trace);
    addTrace(lane,
             {trace, signal.name(), QString::fromUtf8(signal.unit), kColour[at], kShapes[at], kPens[at], 1,
              signal.decimals, false, true},
             false);
    ++at;
  }
}

void TimePlot::addTrace(Lane& lane, TraceGraph::Look look, bool right) {
  QCPAxis* value = lane.rect->axis(right ? QCPAxis::atRight : QCPAxis::atLeft);
  if (right) {
    value->setVisible(true);
    value->setTickLabels(true);
  }
  auto* graph = new TraceGraph(lane.rect->axis(QCPAxis::atBottom), value, std::move(look));
  if (!graph->look().rare) graph->addToLegend(lane.legend);
  traces_.push_back(graph);
}

void TimePlot::arrange() {
  // The lanes are one above the other, or in two columns if the dock is wide and too low for that.
  const QSize room = parentWidget() ? parentWidget()->size() : size();
  const int count = static_cast<int>(lanes_.size());
  const int columns =
      count > 1 && room.width() > kWidePx && room.height() < count * kLanePx + kTimeAxisPx ? 2 : 1;
  if (columns == columns_) return;
  columns_ = columns;
  for (Lane& lane : lanes_) plotLayout()->take(lane.cell);
  plotLayout()->simplify();
  const int rows = (count + columns - 1) / columns;
  for (int i = 0; i < count; ++i) {
    // They fill the first column from the top, then the second.
    const Lane& lane = lanes_[static_cast<std::size_t>(i)];
    plotLayout()->addElement(i % rows, i / rows, lane.cell);
    lane.rect->setMarginGroup(QCP::msLeft | QCP::msRight, columnMargins_[static_cast<std::size_t>(i / rows)]);
    const bool lowest = i % rows == rows - 1 || i == count - 1;
    lane.rect->axis(QCPAxis::atBottom)->setTickLabels(lowest);
    lane.rect->axis(QCPAxis::atBottom)->setLabel(lowest ? tr("Time (s)") : QString());
  }
  updateGeometry();
}

QSize TimePlot::minimumSizeHint() const {
  return {260, std::max(leastHeight_, 120)};
}

/// Legends need more rows in a narrow dock. The scroll area around the plot learns the height from its size
/// hint.
void TimePlot::onLaidOut() {
  const int least = plotLayout()->minimumOuterSizeHint().height();
  if (least == leastHeight_) return;
  leastHeight_ = least;
  updateGeometry();
}

QSize TimePlot::sizeHint() const {
  const int count = static_cast<int>(content_.size());
  return {560, std::max(count * kLanePx + kTimeAxisPx, 170)};
}

void TimePlot::resizeEvent(QResizeEvent* event) {
  arrange();
  Plot::resizeEvent(event);
}

std::size_t TimePlot::laneAt(QPointF pixel) const {
  for (std::size_t i = 0; i < lanes_.size(); ++i)
    if (lanes_[i].cell->outerRect().contains(pixel.toPoint())) return i;
  return lanes_.size() - 1;
}

void TimePlot::contextMenuEvent(QContextMenuEvent* event) {
  if (event->reason() == QContextMenuEvent::Mouse) current_ = laneAt(event->pos());
  const std::size_t lane = current_;
  const PlotLane content = content_[lane];
  QMenu menu(this);
  QMenu* add = menu.addMenu(tr("Add signal"));
  QMenu* fresh = menu.addMenu(tr("New plot with"));
  for (const PlotSignal& signal : plotSignals()) {
    fresh->addAction(signal.fullName(), this, [this, trace = signal.trace] { addLane({{trace}}); });
    if (std::ranges::count(content.traces, signal.trace) == 0)
      add->addAction(signal.fullName(), this, [=, this, trace = signal.trace] { addSignal(lane, trace); });
  }
  fresh->addAction(tr("stages, stacked"), this, [this] { addLane({{}, true}); });
  if (!content.traces.empty()) {
    QMenu* remove = menu.addMenu(tr("Remove signal"));
    for (const Trace trace : content.traces)
      remove->addAction(signalOf(trace).fullName(), this, [=, this] { removeSignal(lane, trace); });
  }
  menu.addAction(tr("Remove this plot"), this, [=, this] { removeLane(lane); })
      ->setEnabled(content_.size() > 1);
  menu.addSeparator();
  menu.addAction(tr("Standard plots"), this, [this] { setLanes(standardLanes()); });
  menu.exec(event->globalPos());
}

void TimePlot::dragEnterEvent(QDragEnterEvent* event) {
  if (event->mimeData()->hasFormat(QLatin1String(kSignalMime))) event->acceptProposedAction();
}

void TimePlot::dropEvent(QDropEvent* event) {
  const auto trace = traceOf(QString::fromUtf8(event->mimeData()->data(QLatin1String(kSignalMime))));
  if (!trace) return;
  event->acceptProposedAction();
  addSignal(laneAt(event->position()), *trace);
}

}  // namespace trimtab::views
