// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QColor>
#include <QList>
#include <QRect>
#include <QString>

class QPainter;

namespace trimtab::workbench {

struct LegendEntry {
  QString text;
  QColor colour;
  friend bool operator==(const LegendEntry&, const LegendEntry&) = default;
};

/// What is painted over the image for the engineer. The pilot never sees it.
struct OverlayContents {
  QString notice;  ///< shown in the middle, instead of an image
  bool frozen = false;
  QString legendTitle;
  QList<LegendEntry> legend;  ///< each entry has a shape of its own, so that it can be read without colour
  QString hud;                ///< one line at the foot of the image
  friend bool operator==(const OverlayContents&, const OverlayContents&) = default;
};

void paintOverlay(QPainter& painter, const QRect& area, const OverlayContents& contents);

}  // namespace trimtab::workbench
