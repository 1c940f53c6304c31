// SPDX-License-Identifier: GPL-3.0-or-later
#include "bar_cell.h"

#include <QPainter>
#include <QStyle>
#include <QWidget>
#include <algorithm>
#include <cmath>

#include "views/model/theme.h"

namespace trimtab::views {

double shownShare(double share) {
  return std::round(share * 100) / 100;
}

void BarCell::paint(QPainter* painter, const QStyleOptionViewItem& option, const QModelIndex& index) const {
  const QVariant bar = index.data(kBarRole);
  if (!bar.isValid()) return QStyledItemDelegate::paint(painter, option, index);
  QStyleOptionViewItem plain = option;
  initStyleOption(&plain, index);
  plain.text.clear();
  option.widget->style()->drawControl(QStyle::CE_ItemViewItem, &plain, painter, option.widget);
  const QColor base = option.palette.color(QPalette::Base), ink = option.palette.color(QPalette::Text);
  const auto colour = index.data(kBarColourRole).value<QColor>();
  const QRectF track = QRectF(option.rect).adjusted(3, 3, -3, -3);
  painter->save();
  painter->fillRect(track, base);
  QRectF filled = track;
  filled.setWidth(track.width() * std::clamp(bar.toDouble(), 0.0, 1.0));
  painter->fillRect(filled, blend(base, colour.isValid() ? colour : seriesColour(3, option.palette), 0.7));
  painter->setPen(blend(base, ink, 0.35));
  painter->drawRect(track);
  painter->setPen(ink);
  painter->drawText(track.adjusted(3, 0, -2, 0), Qt::AlignVCenter | Qt::AlignLeft,
                    index.data(Qt::DisplayRole).toString());
  painter->restore();
}

}  // namespace trimtab::views
