// SPDX-License-Identifier: GPL-3.0-or-later
#include "overlay.h"

#include <QFontMetrics>
#include <QObject>
#include <QPainter>

namespace trimtab::workbench {
namespace {

constexpr int kMargin = 8;
const QColor kPlate(0, 0, 0, 150);

QFont scaled(QFont font, double factor) {
  font.setPointSizeF(font.pointSizeF() * factor);
  return font;
}

enum class Shape { square, triangle, circle };

void paintShape(QPainter& painter, Shape shape, const QRectF& box, const QColor& colour) {
  painter.setPen(QPen(Qt::white, 1));
  painter.setBrush(colour);
  switch (shape) {
    case Shape::square:
      painter.drawRect(box);
      break;
    case Shape::circle:
      painter.drawEllipse(box);
      break;
    case Shape::triangle:
      painter.drawPolygon(
          QPolygonF{{box.topLeft() + QPointF(box.width() / 2, 0), box.bottomRight(), box.bottomLeft()}});
      break;
  }
}

void paintFreezeBanner(QPainter& painter, const QRect& area) {
  const QFont font = scaled(painter.font(), 1.2);
  const QFontMetrics metrics(font);
  const QString text =
      QObject::tr("CULLING FROZEN - the view flies on, tiles stay as they were (Ctrl+F ends it)");
  const QString fits = metrics.elidedText(text, Qt::ElideRight, area.width() - 4 * kMargin);
  QRect plate(0, 0, metrics.horizontalAdvance(fits) + 4 * kMargin, metrics.height() + 2 * kMargin);
  plate.moveTo(area.center().x() - plate.width() / 2, area.top() + kMargin);
  painter.save();
  painter.setFont(font);
  painter.fillRect(plate, QColor(190, 60, 0, 230));
  painter.setPen(Qt::white);
  painter.drawText(plate, Qt::AlignCenter, fits);
  painter.restore();
}

void paintLegend(QPainter& painter, const QRect& area, const QString& title,
                 const QList<LegendEntry>& entries) {
  const QFontMetrics metrics(painter.font());
  const int line = metrics.height() + 4, mark = metrics.ascent();
  int width = metrics.horizontalAdvance(title);
  for (const LegendEntry& entry : entries)
    width = std::max(width, mark + kMargin + metrics.horizontalAdvance(entry.text));
  QRect plate(0, 0, width + 2 * kMargin, line * int(entries.size() + 1) + 2 * kMargin);
  plate.moveBottomRight(area.bottomRight() - QPoint(kMargin, kMargin));
  painter.save();
  painter.fillRect(plate, kPlate);
  painter.setPen(Qt::white);
  int y = plate.top() + kMargin;
  painter.drawText(QRect(plate.left() + kMargin, y, width, line), Qt::AlignVCenter | Qt::AlignLeft, title);
  constexpr Shape kShapes[] = {Shape::square, Shape::triangle, Shape::circle};
  for (qsizetype i = 0; i < entries.size(); ++i) {
    y += line;
    paintShape(painter, kShapes[i % 3], QRectF(plate.left() + kMargin, y + (line - mark) / 2.0, mark, mark),
               entries[i].colour);
    painter.setPen(Qt::white);
    painter.drawText(QRect(plate.left() + 2 * kMargin + mark, y, width, line),
                     Qt::AlignVCenter | Qt::AlignLeft, entries[i].text);
  }
  painter.restore();
}

void paintHud(QPainter& painter, const QRect& area, const QString& text) {
  if (text.isEmpty()) return;
  const QFontMetrics metrics(painter.font());
  const QString fits = metrics.elidedText(text, Qt::ElideRight, area.width() - 4 * kMargin);
  QRect plate(0, 0, metrics.horizontalAdvance(fits) + 2 * kMargin, metrics.height() + kMargin);
  plate.moveBottomLeft(area.bottomLeft() + QPoint(kMargin, -kMargin));
  painter.save();
  painter.fillRect(plate, kPlate);
  painter.setPen(Qt::white);
  painter.drawText(plate, Qt::AlignCenter, fits);
  painter.restore();
}

void paintNotice(QPainter& painter, const QRect& area, const QString& text) {
  painter.save();
  painter.setFont(scaled(painter.font(), 1.3));
  painter.setPen(QColor(220, 220, 220));
  painter.drawText(area.adjusted(40, 20, -40, -20), Qt::AlignCenter | Qt::TextWordWrap, text);
  painter.restore();
}

}  // namespace

void paintOverlay(QPainter& painter, const QRect& area, const OverlayContents& contents) {
  painter.setRenderHint(QPainter::Antialiasing);
  if (!contents.notice.isEmpty()) return paintNotice(painter, area, contents.notice);
  if (contents.frozen) paintFreezeBanner(painter, area);
  if (!contents.legend.isEmpty()) paintLegend(painter, area, contents.legendTitle, contents.legend);
  paintHud(painter, area, contents.hud);
}

}  // namespace trimtab::workbench
