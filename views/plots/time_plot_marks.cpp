// SPDX-License-Identifier: GPL-3.0-or-later
#include "time_plot_marks.h"

#include "views/model/theme.h"

namespace trimtab::views {
namespace {

constexpr int kBarPx = 4, kTickPx = 4;

}  // namespace

TimePlot::Marks::Marks(TimePlot& plot, const PlotMarks& marks, QCPAxisRect* lane, bool first)
    : QCPAbstractItem(&plot), plot_(plot), marks_(marks), lane_(lane), first_(first) {
  setClipToAxisRect(true);
  setClipAxisRect(lane);
}

void TimePlot::Marks::drawSpan(QCPPainter* painter, const PlotMarks::Span& span, double from,
                               double to) const {
  const QRect area = lane_->rect();
  const bool silent = span.kind == PlotMarks::Kind::host_silent;
  const QColor colour = silent ? warningColour(plot_.palette()) : errorColour(plot_.palette());
  const int height = silent ? area.height() : kBarPx;
  const QRectF shape(from, area.top(), std::max(to - from, 1.0), height);
  QColor shade = colour;
  shade.setAlpha(silent ? 110 : 255);
  painter->fillRect(shape, silent ? QBrush(shade, Qt::BDiagPattern) : QBrush(shade));
  if (!first_) return;
  const QString text = silent ? tr("host silent") : tr("recording");
  const QFontMetrics metrics(plot_.font());
  const double width = metrics.horizontalAdvance(text) + 6;
  if (width > shape.width() && to < area.right()) return;
  const double left = std::max(double(area.left()), std::min(from, area.right() - width));
  // Silence is named at the bottom and a recording at the top, so that neither text covers the other.
  const double top = silent ? area.bottom() - metrics.height() - kTickPx : area.top() + kBarPx;
  QColor back = plot_.palette().color(QPalette::Base);
  back.setAlpha(220);
  painter->fillRect(QRectF(left, top, width, metrics.height()), back);
  painter->setPen(colour);
  painter->drawText(QRectF(left, top, width, metrics.height()), Qt::AlignCenter, text);
}

void TimePlot::Marks::draw(QCPPainter* painter) {
  const QCPAxis* time = lane_->axis(QCPAxis::atBottom);
  const QCPRange shown = time->range();
  painter->setFont(plot_.font());
  for (const PlotMarks::Span& span : marks_.spans()) {
    const double to = span.to.value_or(shown.upper);
    if (span.from > shown.upper || to < shown.lower) continue;
    drawSpan(painter, span, time->coordToPixel(std::max(span.from, shown.lower)),
             time->coordToPixel(std::min(to, shown.upper)));
  }
  painter->setPen(Qt::NoPen);
  painter->setBrush(plot_.palette().color(QPalette::Text));
  painter->setAntialiasing(true);
  const double foot = lane_->rect().bottom() + 1;
  const auto& changes = marks_.changes();
  for (auto change = std::ranges::lower_bound(changes, shown.lower, {}, &PlotMarks::Change::time);
       change != changes.end() && change->time <= shown.upper; ++change) {
    const double x = time->coordToPixel(change->time);
    painter->drawPolygon(QPolygonF({{x - kTickPx, foot}, {x + kTickPx, foot}, {x, foot - 1.5 * kTickPx}}));
  }
}

}  // namespace trimtab::views
