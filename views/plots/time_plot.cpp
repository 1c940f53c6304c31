// SPDX-License-Identifier: GPL-3.0-or-later
#include "time_plot.h"

#include <algorithm>
#include <cmath>

#include "views/model/theme.h"

namespace trimtab::views {

namespace {
constexpr int kLowPx = 330, kWidePx = 560;
constexpr int kRoomForBudgetTextPx = 420;
constexpr std::size_t kStageLane = 3;
constexpr double kShortestSpanS = 0.05, kLongestSpanS = 3600 * 4;
/// A frame that took longer than this many usual ones does not flatten the others: the axis ends here.
constexpr double kMostOverUsual = 4;
}  // namespace

TimePlot::TimePlot(const TraceBuffer& buffer, Lanes lanes, QWidget* parent)
    : Plot(tr("Live plots"), Keyboard::used, parent),
      buffer_(buffer),
      firstLane_(lanes == Lanes::all ? 0 : kStageLane) {
  setAccessibleDescription(
      tr("Space pauses, F follows, plus and minus zoom, the arrow keys move the view, or with cursors shown "
         "the cursor "
         "chosen by A or B."));
  setNoAntialiasingOnDrag(true);
  setAutoAddPlottableToLegend(false);
  setPlottingHints(QCP::phFastPolylines | QCP::phCacheLabels);
  setNotAntialiasedElements(QCP::aeAxes | QCP::aeGrid | QCP::aeSubGrid | QCP::aePlottables | QCP::aeFills);
  // Pan and zoom are made here, so that zooming keeps the newest frame at the edge while it is followed.
  plotLayout()->clear();
  plotLayout()->setRowSpacing(2);
  addOverlays({"cursors", "tracker"});
  if (firstLane_ == 0) {
    makeLane(tr("Membership"), 2.6, false);
    makeLane(tr("Triangles, vertices (k)"), 0, false);
    makeLane(tr("Frame (ms)"), 0, true);
  }
  makeLane(tr("Stages (ms)"), 0, true);
  using S = QCPScatterStyle;
  addTrace(0, {Trace::altitude_membership, tr("altitude"), {}, 0, S::ssCircle, Qt::SolidLine, 1, 3});
  addTrace(0, {Trace::pitch_membership, tr("pitch"), {}, 2, S::ssSquare, Qt::SolidLine, 1, 3});
  addTrace(0, {Trace::total_membership, tr("total"), {}, 1, S::ssDiamond, Qt::SolidLine, 1, 3});
  addTrace(
      1, {Trace::triangles, tr("triangles"), QStringLiteral("k"), 3, S::ssTriangle, Qt::SolidLine, 1e-3, 1});
  addTrace(2, {Trace::frame_ms, tr("frame"), QStringLiteral("ms"), 0, S::ssCircle, Qt::SolidLine, 1, 2});
  addTrace(2, {Trace::fps, tr("rate"), tr("fps, right"), 2, S::ssSquare, Qt::SolidLine, 1, 1},
           QStringLiteral("fps"));
  // The highest edge first: each next one is drawn over its foot.
  const QString stageNames[]{tr("select"), tr("page"), tr("occlusion"), tr("cull"), tr("draw")};
  constexpr int kStageColours[]{3, 6, 1, 2, 0};
  for (std::size_t i = kStack.size(); i-- > 0;)
    addTrace(kStageLane, {kStack[i].top, stageNames[i], QStringLiteral("ms"), kStageColours[i], S::ssNone,
                          Qt::SolidLine, 1, 2, true});
  // What runs beside the stages, and parts of one of them.
  const auto addLine = [this](Trace trace, const QString& name, int colour, S::ScatterShape shape,
                              Qt::PenStyle pen) {
    addTrace(kStageLane, {trace, name, QStringLiteral("ms"), colour, shape, pen, 1, 2, false, true});
  };
  addLine(Trace::gpu_ms, tr("GPU"), 5, S::ssCircle, Qt::SolidLine);
  addLine(Trace::blur_ms, tr("blur"), 4, S::ssSquare, Qt::DashLine);
  addLine(Trace::weather_ms, tr("weather"), 6, S::ssTriangle, Qt::DotLine);
  addLine(Trace::symbology_ms, tr("symbols"), 2, S::ssDiamond, Qt::DashDotLine);
  addTrace(0, {Trace::head_rate_degps, tr("head"), tr("deg/s, right"), 5, S::ssNone, Qt::DotLine, 1, 1},
           tr("deg/s"));
  addTrace(1, {Trace::lod_scale, tr("LOD scale"), tr("right"), 1, S::ssNone, Qt::DashLine, 1, 2},
           tr("LOD scale"));
  addTrace(1, {Trace::vertices, tr("vertices"), QStringLiteral("k"), 2, S::ssSquare, Qt::DotLine, 1e-3, 1});
  for (std::size_t i = 0; i < 2; ++i) {
    cursorText_[i] = new QCPItemText(this);
    cursorText_[i]->setLayer(QStringLiteral("cursors"));
    cursorText_[i]->setText(i == 0 ? QStringLiteral("A") : QStringLiteral("B"));
    cursorText_[i]->setPositionAlignment(Qt::AlignHCenter | Qt::AlignBottom);
    cursorText_[i]->position->setAxes(timeAxis(), lanes_.front().rect->axis(QCPAxis::atLeft));
    cursorText_[i]->position->setTypeY(QCPItemPosition::ptAxisRectRatio);
    cursorText_[i]->position->setAxisRect(lanes_.front().rect);
    cursorText_[i]->setPadding(QMargins(4, 1, 4, 1));
    cursorText_[i]->setVisible(false);
  }
  for (QCPMarginGroup*& group : columnMargins_) group = new QCPMarginGroup(this);
  arrange();
  setShown(0, span_);
  restyle();
}

void TimePlot::makeLane(const QString& title, double fixedTop, bool budget) {
  Lane lane;
  lane.fixedTop = fixedTop;
  lane.rect = new QCPAxisRect(this, true);
  plotLayout()->addElement(static_cast<int>(lanes_.size()), 0, lane.rect);
  lane.rect->setMinimumMargins(QMargins(4, 4, 4, 2));
  QCPAxis *time = lane.rect->axis(QCPAxis::atBottom), *left = lane.rect->axis(QCPAxis::atLeft);
  left->setLabel(title);
  left->ticker()->setTickCount(3);
  left->setSubTicks(false);
  time->setSubTicks(false);
  time->setTickLabels(false);
  time->ticker()->setTickCount(6);
  time->setNumberFormat(QStringLiteral("f"));
  lane.legend = new QCPLegend;
  lane.rect->insetLayout()->addElement(lane.legend, Qt::AlignLeft | Qt::AlignTop);
  lane.rect->insetLayout()->setMargins(QMargins(4, 3, 4, 3));
  lane.legend->setLayer(QStringLiteral("legend"));
  lane.legend->setFillOrder(QCPLayoutGrid::foColumnsFirst);
  lane.legend->setMargins(QMargins(4, 1, 4, 1));
  lane.legend->setIconSize(22, 10);
  if (budget) {
    lane.budget = addLine("main", lane.rect);
    for (QCPItemText** text : {&lane.budgetText, &lane.longest}) {
      *text = new QCPItemText(this);
      (*text)->setClipAxisRect(lane.rect);
      (*text)->position->setAxes(time, left);
      (*text)->position->setTypeX(QCPItemPosition::ptAxisRectRatio);
      (*text)->position->setAxisRect(lane.rect);
    }
    lane.budgetText->setPositionAlignment(Qt::AlignRight | Qt::AlignBottom);
    lane.longest->position->setTypeY(QCPItemPosition::ptAxisRectRatio);
    lane.longest->setPositionAlignment(Qt::AlignRight | Qt::AlignTop);
  }
  for (QCPItemStraightLine*& cursor : lane.cursor) {
    cursor = addLine("cursors", lane.rect);
    cursor->setVisible(false);
  }
  lane.tracker = addLine("tracker", lane.rect);
  lane.tracker->setVisible(false);
  lanes_.push_back(lane);
}

void TimePlot::arrange() {
  // Four lanes one above the other, or two by two in a dock that is wide and low.
  const int columns = lanes_.size() > 1 && height() < kLowPx && width() > kWidePx ? 2 : 1;
  if (columns == columns_) return;
  columns_ = columns;
  for (Lane& lane : lanes_) plotLayout()->take(lane.rect);
  plotLayout()->simplify();
  const int rows = static_cast<int>(lanes_.size()) / columns;
  for (int i = 0; i < static_cast<int>(lanes_.size()); ++i) {
    // Down the first column, then down the second.
    QCPAxisRect* rect = lanes_[static_cast<std::size_t>(i)].rect;
    plotLayout()->addElement(i % rows, i / rows, rect);
    rect->setMarginGroup(QCP::msLeft | QCP::msRight, columnMargins_[static_cast<std::size_t>(i / rows)]);
    const bool lowest = i % rows == rows - 1;
    rect->axis(QCPAxis::atBottom)->setTickLabels(lowest);
    rect->axis(QCPAxis::atBottom)->setLabel(lowest ? tr("Time (s)") : QString());
  }
}

void TimePlot::resizeEvent(QResizeEvent* event) {
  arrange();
  Plot::resizeEvent(event);
}

void TimePlot::addTrace(std::size_t lane, TraceGraph::Look look, const QString& right) {
  if (lane < firstLane_) return;
  const Lane& into = lanes_[lane - firstLane_];
  QCPAxisRect* rect = into.rect;
  QCPAxis* value = rect->axis(right.isEmpty() ? QCPAxis::atLeft : QCPAxis::atRight);
  if (!right.isEmpty()) {
    value->setVisible(true);
    value->setTickLabels(true);
    value->setSubTicks(false);
    value->ticker()->setTickCount(3);
    value->setLabel(right);
  }
  TraceGraph* graph = new TraceGraph(rect->axis(QCPAxis::atBottom), value, std::move(look));
  // The stages' lane says their unit, and its legend has many entries.
  if (lane == kStageLane) graph->setName(graph->look().name);
  if (!graph->look().rare) graph->addToLegend(into.legend);
  traces_.push_back(graph);
}

void TimePlot::restyle() {
  applyTheme(*this);
  const QPalette& p = palette();
  const QColor ink = p.color(QPalette::Text), base = p.color(QPalette::Base);
  for (TraceGraph* trace : traces_) trace->colour(p);
  QColor back = base;
  back.setAlpha(200);
  for (Lane& lane : lanes_) {
    lane.legend->setBrush(back);
    lane.legend->setBorderPen(Qt::NoPen);
    lane.legend->setTextColor(ink);
    lane.legend->setFont(font());
    if (lane.budget) {
      lane.budget->setPen(QPen(errorColour(p), 1.4, Qt::DashLine));
      for (QCPItemText* text : {lane.budgetText, lane.longest}) {
        text->setColor(errorColour(p));
        text->setFont(font());
      }
    }
    lane.cursor[0]->setPen(QPen(ink, 1.2));
    lane.cursor[1]->setPen(QPen(ink, 1.2, Qt::DashDotLine));
    lane.tracker->setPen(QPen(blend(base, ink, 0.4), 1, Qt::DotLine));
  }
  for (QCPItemText* text : cursorText_) {
    text->setColor(base);
    text->setBrush(ink);
    text->setFont(font());
  }
  draw();
}

void TimePlot::setBudget(double ms) {
  budget_ = ms;
  for (Lane& lane : lanes_)
    if (lane.budget) {
      putHorizontal(*lane.budget, ms);
      lane.budgetText->setText(tr("budget %1 ms").arg(numberText(ms, 2)));
      lane.budgetText->position->setCoords(0.995, ms);
    }
  draw();
}

void TimePlot::setShown(double from, double to) {
  span_ = std::clamp(to - from, kShortestSpanS, kLongestSpanS);
  for (Lane& lane : lanes_) lane.rect->axis(QCPAxis::atBottom)->setRange(from, from + span_);
  draw();
}

void TimePlot::setSpan(double seconds) {
  const double right = shown().upper;
  span_ = std::clamp(seconds, kShortestSpanS, kLongestSpanS);
  if (following_ && !buffer_.empty())
    refresh(true);
  else
    setShown(right - span_, right);
}

void TimePlot::refresh(bool follow) {
  following_ = follow;
  if (follow && !buffer_.empty()) {
    const double newest = buffer_.time(buffer_.end() - 1), oldest = buffer_.time(buffer_.begin());
    // The first frames start at the left edge.
    const double from = newest - oldest < span_ ? oldest : newest - span_;
    setShown(from, from + span_);
  } else {
    draw();
  }
}

double TimePlot::shownTop(const Lane& lane, double longest, double usual) const {
  const double most = kMostOverUsual * std::max(usual, budget_);
  lane.longest->setVisible(longest > most);
  if (longest > most) {
    lane.longest->setText(tr("longest %L1 ms ↑").arg(longest, 0, 'f', 0));
    const QRect area = lane.rect->rect();
    const double below = lane.legend->outerRect().bottom() - area.top();
    lane.longest->position->setCoords(0.995, below / std::max(1, area.height()));
  }
  return std::clamp(longest, budget_, most);
}

void TimePlot::draw() {
  const QCPRange range = shown();
  // One frame more on each side, so that lines reach the edges.
  std::uint64_t from = buffer_.atOrAfter(range.lower), to = buffer_.atOrAfter(range.upper);
  if (from > buffer_.begin()) --from;
  if (to < buffer_.end()) ++to;
  const std::size_t columns = static_cast<std::size_t>(std::max(100, lanes_.front().rect->width() / 2));
  const double markerStep = roundStep(range.size() / 5);
  std::array<double, 4> top{}, topRight{}, usual{};
  for (TraceGraph* trace : traces_) {
    const TraceGraph::Heights heights = trace->take(buffer_, from, to, columns, markerStep);
    const bool onRight = trace->valueAxis()->axisType() == QCPAxis::atRight;
    for (std::size_t i = 0; i < lanes_.size(); ++i)
      if (lanes_[i].rect == trace->keyAxis()->axisRect()) {
        double& highest = (onRight ? topRight : top)[i];
        highest = std::max(highest, heights.largest);
        if (!onRight) usual[i] = std::max(usual[i], heights.usual);
        if (heights.largest > 0 && !lanes_[i].legend->hasItemWithPlottable(trace))
          trace->addToLegend(lanes_[i].legend);
      }
  }
  for (std::size_t i = 0; i < lanes_.size(); ++i) {
    double high = lanes_[i].fixedTop;
    if (high == 0) {
      // Room above for the legend; the budget line stays in sight.
      if (lanes_[i].budget) top[i] = shownTop(lanes_[i], top[i], usual[i]);
      high = top[i] > 0 ? top[i] * 1.4 : 1;
    }
    lanes_[i].rect->axis(QCPAxis::atLeft)->setRange(0, high);
    lanes_[i].rect->axis(QCPAxis::atRight)->setRange(0, topRight[i] > 0 ? topRight[i] * 1.4 : 100);
    // In a narrow dock the legend needs the room, and so does that of the stages in any.
    if (lanes_[i].budgetText)
      lanes_[i].budgetText->setVisible(i + firstLane_ != kStageLane &&
                                       width() / columns_ > kRoomForBudgetTextPx);
  }
  for (Lane& lane : lanes_)
    lane.rect->axis(QCPAxis::atBottom)->setNumberPrecision(span_ < 2 ? 2 : span_ <= 25 ? 1 : 0);
  placeCursors();
  replot(QCustomPlot::rpQueuedReplot);
}

void TimePlot::setCursors(bool on) {
  if (on == hasCursors()) return;
  if (on)
    cursors_ = {shown().lower + shown().size() / 3, shown().lower + 2 * shown().size() / 3};
  else
    cursors_.reset();
  placeCursors();
  layer(QStringLiteral("cursors"))->replot();
  emit cursorsMoved();
}

void TimePlot::moveCursor(int which, double time) {
  if (!cursors_) return;
  (*cursors_)[static_cast<std::size_t>(which)] = time;
  placeCursors();
  layer(QStringLiteral("cursors"))->replot();
  emit cursorsMoved();
}

void TimePlot::placeCursors() {
  for (std::size_t i = 0; i < 2; ++i) {
    for (Lane& lane : lanes_) {
      lane.cursor[i]->setVisible(hasCursors());
      if (cursors_) putVertical(*lane.cursor[i], (*cursors_)[i]);
    }
    cursorText_[i]->setVisible(hasCursors());
    if (cursors_) cursorText_[i]->position->setCoords((*cursors_)[i], 1);
  }
}

QPointF TimePlot::pixelOfTime(double time) const {
  return {timeAxis()->coordToPixel(time), static_cast<double>(lanes_.front().rect->center().y())};
}

}  // namespace trimtab::views
