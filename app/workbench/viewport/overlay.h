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

/// What is painted over the picture for the engineer, not for the pilot.
struct OverlayContents {
  QString notice;  ///< in the middle, instead of a picture
  bool frozen = false;
  QString legendTitle;
  QList<LegendEntry> legend;  ///< each has a shape of its own, so that it reads without colour
  QString hud;                ///< one line at the foot
  friend bool operator==(const OverlayContents&, const OverlayContents&) = default;
};

void paintOverlay(QPainter& painter, const QRect& area, const OverlayContents& contents);

}  // namespace trimtab::workbench
