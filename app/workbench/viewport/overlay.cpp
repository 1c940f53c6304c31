// SPDX-License-Identifier: GPL-3.0-or-later
#include "overlay.h"

#include <QFontMetrics>
#include <QObject>
#include <QPainter>
#include <algorithm>
#include <utility>

namespace trimtab::workbench {
namespace {

constexpr int kMargin = 8;
/// The inset's width and height are at most those of the area divided by this.
constexpr double kInsetPart = 3.5;
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

void paintBanner(QPainter& painter, const QRect& area, const QString& text) {
  const QFont font = scaled(painter.font(), 1.2);
  const QRect words = QFontMetrics(font).boundingRect(
      area.adjusted(3 * kMargin, 2 * kMargin, -3 * kMargin, 0), Qt::AlignHCenter | Qt::TextWordWrap, text);
  const QRect plate = words.adjusted(-2 * kMargin, -kMargin, 2 * kMargin, kMargin);
  painter.save();
  painter.setFont(font);
  painter.fillRect(plate, QColor(190, 60, 0, 230));
  painter.setPen(Qt::white);
  painter.drawText(words, Qt::AlignHCenter | Qt::TextWordWrap, text);
  painter.restore();
}

/// Dark under light, so that it shows on snow and on water.
void paintOutline(QPainter& painter, const QRectF& image, const QList<QLineF>& edges) {
  painter.save();
  painter.setClipRect(image);
  const auto place = [&image](const QPointF& part) {
    return image.topLeft() + QPointF(part.x() * image.width(), part.y() * image.height());
  };
  for (const auto& [colour, width] : {std::pair{QColor(0, 0, 0, 200), 4.0}, {QColor(Qt::white), 2.0}}) {
    painter.setPen(QPen(colour, width));
    for (const QLineF& edge : edges) painter.drawLine(place(edge.p1()), place(edge.p2()));
  }
  painter.restore();
}

void paintInsetFrame(QPainter& painter, const QRect& inset) {
  const QFontMetrics metrics(painter.font());
  const QString title = QObject::tr("The pilot's view");
  painter.save();
  painter.setBrush(Qt::NoBrush);
  painter.setPen(QPen(Qt::white, 2));
  painter.drawRect(inset);
  QRect plate(inset.topLeft(), QSize(metrics.horizontalAdvance(title) + 2 * kMargin, metrics.height() + 4));
  painter.fillRect(plate, kPlate);
  painter.drawText(plate, Qt::AlignCenter, title);
  painter.restore();
}

/// How far from the bottom of the image whatever stands over the line of numbers ends.
int aboveHud(const QFontMetrics& metrics) {
  return metrics.height() + 3 * kMargin;
}

void paintLegend(QPainter& painter, const QRect& area, const QString& title,
                 const QList<LegendEntry>& entries) {
  const QFontMetrics metrics(painter.font());
  const int line = metrics.height() + 4, mark = metrics.ascent();
  int width = metrics.horizontalAdvance(title);
  for (const LegendEntry& entry : entries)
    width = std::max(width, mark + kMargin + metrics.horizontalAdvance(entry.text));
  QRect plate(0, 0, width + 2 * kMargin, line * int(entries.size() + 1) + 2 * kMargin);
  plate.moveBottomRight(area.bottomRight() - QPoint(kMargin, aboveHud(metrics)));
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

QRect insetIn(const QRect& area, const QSize& pixels, const QFontMetrics& metrics) {
  QRect inset({}, pixels.scaled(area.size() / kInsetPart, Qt::KeepAspectRatio));
  inset.moveBottomLeft(area.bottomLeft() + QPoint(kMargin, -aboveHud(metrics)));
  return inset;
}

void paintOverlay(QPainter& painter, const QRect& area, const OverlayContents& contents) {
  painter.setRenderHint(QPainter::Antialiasing);
  if (!contents.notice.isEmpty()) return paintNotice(painter, area, contents.notice);
  if (!contents.outline.isEmpty()) paintOutline(painter, contents.image, contents.outline);
  if (!contents.inset.isEmpty()) paintInsetFrame(painter, contents.inset);
  if (!contents.banner.isEmpty()) paintBanner(painter, area, contents.banner);
  if (!contents.legend.isEmpty()) paintLegend(painter, area, contents.legendTitle, contents.legend);
  paintHud(painter, area, contents.hud);
}

}  // namespace trimtab::workbench
