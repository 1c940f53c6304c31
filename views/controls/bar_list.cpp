// SPDX-License-Identifier: GPL-3.0-or-later
#include "bar_list.h"

#include <QPainter>
#include <algorithm>

#include "views/model/theme.h"

namespace trimtab::views {

BarList::BarList(QWidget* parent) : QWidget(parent) {
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
}

void BarList::setBars(std::vector<Bar> bars) {
  if (bars == bars_) return;
  const bool resized = bars.size() != bars_.size();
  bars_ = std::move(bars);
  QString said;
  for (const Bar& bar : bars_) said += tr("%1 %2. ").arg(bar.name, bar.text);
  setAccessibleDescription(said);
  if (resized) updateGeometry();
  update();
}

int BarList::lineHeight() const {
  return fontMetrics().height() + 4;
}
int BarList::nameWidth() const {
  int width = 0;
  for (const Bar& bar : bars_) width = std::max(width, fontMetrics().horizontalAdvance(bar.name));
  return width + 8;
}
int BarList::textWidth() const {
  int width = fontMetrics().horizontalAdvance(QStringLiteral("0.000"));
  for (const Bar& bar : bars_) width = std::max(width, fontMetrics().horizontalAdvance(bar.text));
  return width + 8;
}

QSize BarList::sizeHint() const {
  return {nameWidth() + textWidth() + 160, lineHeight() * static_cast<int>(bars_.size())};
}
QSize BarList::minimumSizeHint() const {
  return {nameWidth() + textWidth() + 40, sizeHint().height()};
}

void BarList::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  const QColor base = palette().color(QPalette::Base), ink = palette().color(QPalette::WindowText);
  const int names = nameWidth(), texts = textWidth(), line = lineHeight();
  int y = 0;
  for (const Bar& bar : bars_) {
    const QColor colour = bar.quiet             ? blend(base, ink, 0.35)
                          : bar.given.isValid() ? bar.given
                                                : seriesColour(bar.colour, palette());
    const QRectF track(names, y + 3, std::max(10, width() - names - texts), line - 6);
    painter.setPen(bar.quiet ? quietColour(palette()) : ink);
    painter.drawText(QRectF(0, y, names, line), Qt::AlignLeft | Qt::AlignVCenter, bar.name);
    painter.drawText(QRectF(track.right() + 8, y, texts, line), Qt::AlignLeft | Qt::AlignVCenter, bar.text);
    painter.fillRect(track, base);
    // A value that is not a number, such as 0 of 0, has no bar.
    const double share = bar.value / bar.top;
    if (share > 0)
      painter.fillRect(
          QRectF(track.left(), track.top(), track.width() * std::min(share, 1.0), track.height()), colour);
    painter.setPen(ink);
    for (const double tick : bar.ticks) {
      const double x = track.left() + track.width() * tick / bar.top;
      painter.drawLine(QPointF(x, track.top() - 2), QPointF(x, track.bottom() + 2));
    }
    painter.setPen(blend(base, ink, 0.4));
    painter.drawRect(track);
    y += line;
  }
}

}  // namespace trimtab::views
