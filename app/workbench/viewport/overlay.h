// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QColor>
#include <QLineF>
#include <QList>
#include <QRect>
#include <QRectF>
#include <QString>

class QFontMetrics;
class QPainter;

namespace trimtab::workbench {

struct LegendEntry {
  QString text;
  QColor colour;
  friend bool operator==(const LegendEntry&, const LegendEntry&) = default;
};

/// What is painted over the image for the engineer. The pilot never sees it.
struct OverlayContents {
  QString notice{};  ///< shown in the middle, instead of an image
  QString banner{};  ///< says at the top that the image is not the pilot's; empty if it is
  QString legendTitle{};
  QList<LegendEntry> legend{};  ///< each entry has a shape of its own, so that it can be read without colour
  QString hud{};                ///< one line at the foot of the image
  QList<QLineF> outline{};      ///< of the picked node, in parts of the image from its upper left corner
  QRectF image{};               ///< where the image lies in the widget
  QRect inset{};                ///< where the pilot's image lies over the observer's; empty if it does not
  friend bool operator==(const OverlayContents&, const OverlayContents&) = default;
};

/// Returns where the pilot's image, `pixels` large, lies over the observer's: small, on the left, above the
/// line at the foot.
QRect insetIn(const QRect& area, const QSize& pixels, const QFontMetrics& metrics);

void paintOverlay(QPainter& painter, const QRect& area, const OverlayContents& contents);

}  // namespace trimtab::workbench
