// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QByteArray>
#include <QString>

#include "trimtab/units/result.h"

class QCustomPlot;
class QPixmap;

namespace trimtab::views {

/// Returns a plot as SVG, as large as it is shown: lines and texts, nothing rasterised.
QByteArray svgOf(QCustomPlot& plot);
/// Writes a plot as it is shown: as SVG if the name ends so, else as PNG with twice as many pixels.
Findings writePicture(QCustomPlot& plot, const QString& file);
/// Writes a picture in the format that the name's ending says, or as PNG if it has none.
Findings writePixmap(const QPixmap& picture, const QString& file);

}  // namespace trimtab::views
