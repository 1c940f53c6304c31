// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace_graph.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "views/model/theme.h"

namespace trimtab::views {

TraceGraph::TraceGraph(QCPAxis* timeAxis, QCPAxis* valueAxis, Look look)
    : QCPGraph(timeAxis, valueAxis), look_(std::move(look)) {
  setName(look_.fullName());
  setAdaptiveSampling(false);  // TraceBuffer::columns() has sampled already
  setSelectable(QCP::stNone);
  setAntialiased(false);  // takes a third of the time, and steep traces hardly show a difference
}

const PlotSignal& TraceGraph::signal() const {
  if (look_.filled)
    for (const StackedStage& stacked : kStack)
      if (stacked.top == look_.trace) return signalOf(stacked.stage);
  return signalOf(look_.trace);
}

void TraceGraph::colour(const QPalette& palette) {
  const QColor colour = seriesColour(look_.colour, palette), base = palette.color(QPalette::Base);
  setPen(QPen(colour, 1, look_.pen));
  if (look_.filled) setBrush(blend(base, colour, 0.55));
  marker_ = QCPScatterStyle(look_.shape, QPen(colour, 1.4), QBrush(base), 7);
}

TraceGraph::Heights TraceGraph::take(const TraceBuffer& buffer, std::uint64_t from, std::uint64_t to,
                                     std::size_t columns, double markerStepS) {
  buffer.columns(look_.trace, from, to, columns, columns_);
  points_.clear();
  highs_.clear();
  // Nothing is drawn across a stretch without frames, because an idle view paints none, nor across one as
  // long in which the value is absent. A shorter absence makes no gap, whether or not it fills a column.
  const double span = columns_.size() > 1 ? columns_.back().time - columns_.front().time : 0;
  const double gap = std::max(TraceBuffer::kGapS, 4 * span / static_cast<double>(columns));
  double least = 0;
  std::optional<double> last;
  for (const TraceBuffer::Column& column : columns_) {
    if (std::isnan(column.high)) continue;
    const double low = column.low * look_.scale, high = column.high * look_.scale;
    if (high > 0) highs_.push_back(high);
    if (low < least) least = low;
    if (last && column.time - *last > gap) points_.append({(column.time + *last) / 2, std::nan("")});
    last = column.time;
    // Stacked areas show their crests; lines show both ends of what a column holds.
    if (low != high && !look_.filled) points_.append({column.time, low});
    points_.append({column.time, high});
  }
  data()->set(points_, true);
  markers_.clear();
  if (from < to && markerStepS > 0) {
    // The frames beside the view may be hours away from it.
    const QCPRange view = keyAxis()->range();
    const double first = std::max(buffer.time(std::max(from, buffer.begin())), view.lower);
    const double end = std::min(buffer.time(to - 1), view.upper);
    for (double t = std::ceil(first / markerStepS) * markerStepS; t <= end; t += markerStepS) {
      const std::uint64_t frame = std::min(buffer.nearest(t), to - 1);
      if (const double v = buffer.value(look_.trace, frame) * look_.scale; std::isfinite(v))
        markers_.append({buffer.time(frame), v});
    }
  }
  if (highs_.empty()) return {0, 0, least};
  // Where few columns have a value, as when a head has turned once, two of them may be above it too.
  const std::size_t above = std::max(highs_.size() / 20, std::min<std::size_t>(highs_.size() / 3, 2));
  const auto usual = highs_.end() - 1 - static_cast<std::ptrdiff_t>(above);
  std::nth_element(highs_.begin(), usual, highs_.end());
  return {*std::max_element(usual, highs_.end()), *usual, least};
}

void TraceGraph::draw(QCPPainter* painter) {
  QCPGraph::draw(painter);
  if (look_.filled) return;
  painter->setAntialiasing(true);
  marker_.applyTo(painter, mPen);
  for (const QPointF& m : markers_) marker_.drawShape(painter, coordsToPixels(m.x(), m.y()));
}

void TraceGraph::drawLegendIcon(QCPPainter* painter, const QRectF& rect) const {
  if (look_.filled) {
    painter->fillRect(rect.adjusted(2, rect.height() / 4, -2, -rect.height() / 4), mBrush);
    return;
  }
  QCPGraph::drawLegendIcon(painter, rect);
  painter->setAntialiasing(true);
  marker_.applyTo(painter, mPen);
  marker_.drawShape(painter, rect.center());
}

}  // namespace trimtab::views
