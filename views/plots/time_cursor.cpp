// SPDX-License-Identifier: GPL-3.0-or-later
#include "time_cursor.h"

#include <cmath>

#include "plot.h"

namespace trimtab::views {

void TimeCursor::attach(Plot& plot, const char* layer, const std::vector<QCPAxisRect*>& rects) {
  lines_.clear();
  for (QCPAxisRect* rect : rects) lines_.push_back(plot.addLine(layer, rect));
  QCPAxisRect* first = rects.front();
  flag_ = new QCPItemText(&plot);
  flag_->setLayer(QString::fromLatin1(layer));
  flag_->setClipToAxisRect(false);
  flag_->setPadding(QMargins(5, 1, 5, 1));
  flag_->position->setAxes(first->axis(QCPAxis::atBottom), first->axis(QCPAxis::atLeft));
  flag_->position->setTypeY(QCPItemPosition::ptAxisRectRatio);
  flag_->position->setAxisRect(first);
  place();
}

void TimeCursor::setLook(const QPen& line, const std::optional<QColor>& flagInk, const QFont& font) {
  for (QCPItemStraightLine* each : lines_) each->setPen(line);
  flagged_ = flagInk.has_value();
  if (!flagInk) return;
  flag_->setColor(*flagInk);
  flag_->setBrush(line.color());
  flag_->setFont(font);
}

void TimeCursor::setFlag(const QString& text) {
  flag_->setText(text);
}

void TimeCursor::place(std::optional<double> time) {
  if (time && !std::isfinite(*time)) time.reset();
  time_ = time;
  for (QCPItemStraightLine* line : lines_) {
    line->setVisible(time.has_value());
    if (time) Plot::putVertical(*line, *time);
  }
  const QCPRange shown = flag_->position->keyAxis()->range();
  flag_->setVisible(flagged_ && time && shown.contains(*time));
  if (!time) return;
  // The flag is on the side of the middle, so that no edge cuts it.
  const bool left = *time > shown.center();
  flag_->setPositionAlignment((left ? Qt::AlignRight : Qt::AlignLeft) | Qt::AlignTop);
  flag_->position->setCoords(*time, 0);
}

}  // namespace trimtab::views
