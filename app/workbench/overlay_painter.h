// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QColor>
#include <QList>
#include <QRect>
#include <QString>

class QPainter;

/// What is painted over the picture for the engineer: banner, legend, one line of figures, a notice.
namespace trimtab::workbench {

struct LegendEntry {
  QString text;
  QColor colour;
};

void paintFreezeBanner(QPainter& painter, const QRect& area);
/// Lower right; each entry has a shape of its own, so that it reads without colour.
void paintLegend(QPainter& painter, const QRect& area, const QString& title,
                 const QList<LegendEntry>& entries);
/// Lower left.
void paintHud(QPainter& painter, const QRect& area, const QString& text);
/// In the middle, instead of a picture.
void paintNotice(QPainter& painter, const QRect& area, const QString& text);

}  // namespace trimtab::workbench
