// SPDX-License-Identifier: GPL-3.0-or-later
#include "time_plot.h"

#include <algorithm>
#include <cmath>

#include "views/model/theme.h"

namespace trimtab::views {

namespace {
constexpr int kRoomForBudgetTextPx = 420;
constexpr double kShortestSpanS = 0.05, kLongestSpanS = 3600 * 4;
constexpr double kHeadRoom = 1.08;
}  // namespace

TimePlot::TimePlot(const TraceBuffer& buffer, const PlotMarks* marks, PlotLanes lanes, QWidget* parent)
    : ClockPlot(tr("Live plots"), Keyboard::used, parent),
      buffer_(buffer),
      marks_(marks),
      content_(std::move(lanes)) {
  setAccessibleDescription(
      tr("Space pauses, F follows, plus and minus zoom, the arrow keys move the view, or with cursors shown "
         "the cursor chosen by A or B. W and Shift+W choose the next and the previous frame that took long. "
         "The menu key adds and removes signals."));
  setAcceptDrops(true);
  setNoAntialiasingOnDrag(true);
  setAutoAddPlottableToLegend(false);
  setPlottingHints(QCP::phFastPolylines | QCP::phCacheLabels);
  setNotAntialiasedElements(QCP::aeAxes | QCP::aeGrid | QCP::aeSubGrid | QCP::aePlottables | QCP::aeFills);
  // Pan and zoom are made here, so that zooming keeps the newest frame at the edge while it is followed.
  plotLayout()->clear();
  plotLayout()->setRowSpacing(2);
  addOverlays({"cursors", "tracker"});
  connect(this, &QCustomPlot::afterLayout, this, &TimePlot::onLaidOut);
  for (QCPMarginGroup*& group : columnMargins_) group = new QCPMarginGroup(this);
  makeLanes();
  setShown(0, span_);
  restyle();
}

void TimePlot::restyle() {
  applyTheme(*this);
  const QPalette& p = palette();
  const QColor ink = p.color(QPalette::Text), base = p.color(QPalette::Base);
  QColor back = base;
  back.setAlpha(200);
  for (TraceGraph* trace : traces_) trace->colour(p);
  for (Lane& lane : lanes_) {
    lane.legend->setBrush(Qt::NoBrush);
    lane.legend->setBorderPen(Qt::NoPen);
    lane.legend->setTextColor(ink);
    lane.legend->setFont(font());
    if (lane.budget) lane.budget->setPen(QPen(errorColour(p), 1.4, Qt::DashLine));
    for (QCPItemText* text : {lane.budgetText, lane.longest})
      if (text) {
        text->setColor(errorColour(p));
        text->setFont(font());
        text->setBrush(back);
      }
  }
  cursor_[0].setLook(QPen(ink, 1.2), base, font());
  cursor_[1].setLook(QPen(ink, 1.2, Qt::DashDotLine), base, font());
  chosen_.setLook(QPen(liveColour(p), 2), base, font());
  styleTracker();
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

void TimePlot::setRobust(bool on) {
  robust_ = on;
  draw();
}

void TimePlot::hold(std::optional<std::uint64_t> end) {
  held_ = end;
}

void TimePlot::setShown(double from, double to) {
  span_ = std::clamp(to - from, kShortestSpanS, kLongestSpanS);
  for (Lane& lane : lanes_) lane.rect->axis(QCPAxis::atBottom)->setRange(from, from + span_);
  draw();
  emit shownChanged();
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
  if (follow && end() > buffer_.begin()) {
    const double newest = buffer_.time(end() - 1), oldest = buffer_.time(buffer_.begin());
    // The first frames start at the left edge.
    const double from = newest - oldest < span_ ? oldest : newest - span_;
    setShown(from, from + span_);
  } else {
    draw();
  }
}

std::pair<std::uint64_t, std::uint64_t> TimePlot::framesShown() const {
  const QCPRange range = shown();
  const std::uint64_t from = std::min(buffer_.atOrAfter(range.lower), end());
  std::uint64_t to = std::min(buffer_.atOrAfter(range.upper), end());
  // The range is closed, as it is in the CSV.
  while (to < end() && buffer_.time(to) <= range.upper) ++to;
  return {from, std::max(from, to)};
}

double TimePlot::topOf(const Side& side, double atLeast, const QString& unit, QStringList& beyond) const {
  const double most = kMostOverUsual * std::max(side.usual, atLeast);
  if (!robust_ || most <= 0 || side.largest <= most) return std::max(side.largest, atLeast);
  const QString text = unit == QStringLiteral("ms") ? tr("longest %1 %2 ↑") : tr("largest %1 %2 ↑");
  beyond << text.arg(numberText(side.largest, side.largest < 10 ? 2 : 0), unit).simplified();
  return std::max(most, atLeast);
}

void TimePlot::draw() {
  const QCPRange range = shown();
  // One frame more on each side lets lines reach the edges.
  auto [from, to] = framesShown();
  if (from > buffer_.begin()) --from;
  if (to < end()) ++to;
  const std::size_t columns = static_cast<std::size_t>(std::max(100, lanes_.front().rect->width() / 2));
  const double markerStep = roundStep(range.size() / 5);
  struct Sides {
    Side left, right;
  };
  std::vector<Sides> sides(lanes_.size());
  for (TraceGraph* trace : traces_) {
    const TraceGraph::Heights heights = trace->take(buffer_, from, to, columns, markerStep);
    const bool onRight = trace->valueAxis()->axisType() == QCPAxis::atRight;
    for (std::size_t i = 0; i < lanes_.size(); ++i)
      if (lanes_[i].rect == trace->keyAxis()->axisRect()) {
        Side& side = onRight ? sides[i].right : sides[i].left;
        side.largest = std::max(side.largest, heights.largest);
        side.usual = std::max(side.usual, heights.usual);
        side.least = std::min(side.least, heights.least);
        const bool measured = heights.largest > 0 || heights.least < 0;
        if (measured && !lanes_[i].legend->hasItemWithPlottable(trace)) trace->addToLegend(lanes_[i].legend);
      }
  }
  for (std::size_t i = 0; i < lanes_.size(); ++i) drawLane(lanes_[i], sides[i].left, sides[i].right);
  placeCursors();
  replot(QCustomPlot::rpQueuedReplot);
}

void TimePlot::drawLane(Lane& lane, const Side& left, const Side& right) {
  QStringList beyond;
  const auto unitOn = [&](QCPAxis::AxisType type) {
    for (const TraceGraph* trace : traces_)
      if (trace->keyAxis()->axisRect() == lane.rect && trace->valueAxis()->axisType() == type)
        return QString::fromUtf8(trace->signal().unit);
    return QString();
  };
  const double top = topOf(left, lane.budget ? budget_ : 0, unitOn(QCPAxis::atLeft), beyond);
  const double topRight = topOf(right, 0, unitOn(QCPAxis::atRight), beyond);
  const auto setRange = [](QCPAxis* axis, double least, double largest) {
    const double high = largest > least ? largest : least + 1;
    const double room = (high - least) * (kHeadRoom - 1);
    axis->setRange(least < 0 ? least - room : 0, high + room);
  };
  setRange(lane.rect->axis(QCPAxis::atLeft), left.least, top);
  setRange(lane.rect->axis(QCPAxis::atRight), right.least, topRight);
  lane.rect->axis(QCPAxis::atBottom)->setNumberPrecision(span_ < 2 ? 2 : span_ <= 25 ? 1 : 0);
  const int width = this->width() / std::max(columns_, 1);
  wrapLegend(*lane.legend, width);
  lane.longest->setVisible(!beyond.isEmpty());
  lane.longest->setText(beyond.join(QLatin1Char('\n')));
  if (lane.budgetText) lane.budgetText->setVisible(width > kRoomForBudgetTextPx);
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
  for (std::size_t i = 0; i < 2; ++i)
    cursor_[i].place(cursors_ ? std::optional((*cursors_)[i]) : std::nullopt);
  chosen_.place();
}

void TimePlot::choose(std::optional<double> time) {
  chosen_.place(time);
  layer(QStringLiteral("cursors"))->replot();
}

QPointF TimePlot::pixelOfTime(double time) const {
  return {timeAxis()->coordToPixel(time), static_cast<double>(lanes_.front().rect->center().y())};
}

}  // namespace trimtab::views
